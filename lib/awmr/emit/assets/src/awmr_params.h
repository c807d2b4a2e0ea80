/* Includes the parameters, which awmr emit writes next to library.properties. */
#include "../awmr_params.h"
