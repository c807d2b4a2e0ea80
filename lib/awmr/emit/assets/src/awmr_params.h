/* The parameters lie beside library.properties, where awmr emit has always written them. */
#include "../awmr_params.h"
