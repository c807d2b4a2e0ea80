// Empty: the SD card of SD.h needs no SPI.
