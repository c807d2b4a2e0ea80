// See Arduino.h.
#pragma once
#include <Arduino.h>
