// SD card that keeps its files in memory.
#pragma once
#include <Arduino.h>

#include <map>
#include <memory>
#define FILE_WRITE 1
class File : public Print {
 public:
  std::shared_ptr<std::string> bytes;
  using Print::write;
  size_t write(uint8_t byte) override {
    if (!bytes) return 0;
    bytes->push_back(static_cast<char>(byte));
    return 1;
  }
  void flush() {}
  operator bool() const { return bytes != nullptr; }
};
struct SDClass {
  std::map<std::string, std::shared_ptr<std::string>> files;
  bool begin(uint8_t) { return true; }
  bool exists(const char* name) { return files.count(name) != 0; }
  File open(const char* name, uint8_t) {
    File file;
    file.bytes = files[name] = std::make_shared<std::string>();
    return file;
  }
};
extern SDClass SD;
