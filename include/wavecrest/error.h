// The one exception that the library throws.
#pragma once

#include <stdexcept>
#include <string>

#include "wavecrest/export.h"

namespace wavecrest::api {

enum class ErrorKind {
  usage,  // options that make no sense
  input,  // a scene, image or results file that cannot be used or written, as on a full disk
  fault   // an error of the library, or of the machine: no memory
};

// what() is one line: "FILE:LINE: what is wrong; what was expected".
class WAVECREST_EXPORT Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& text, const std::string& file = {}, int line = 0);
  ~Error() override;

  ErrorKind kind() const { return kind_; }
  const std::string& file() const { return file_; }  // empty: no file is to blame, or what() alone names it
  int line() const { return line_; }                 // from 1 on; 0: the whole file

 private:
  ErrorKind kind_;
  std::string file_;
  int line_;
};

}  // namespace wavecrest::api
