// An open file of the system, closed with the object.
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <string>

namespace trocar {

class Descriptor {
 public:
  // flags: of open(2).
  Descriptor(const std::string& file, int flags) : number_(open(file.c_str(), flags, 0666)) {}
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }  // below 0 and errno set: it can't be opened

 private:
  int number_;
};

}  // namespace trocar
