/* The parameters are next to library.properties, where awmr emit writes them. */
#include "../awmr_params.h"
