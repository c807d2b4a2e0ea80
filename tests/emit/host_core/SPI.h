// See SD.h.
