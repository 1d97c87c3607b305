// Errors of libjpeg, for those who call it: engine/load reads JPEG files, bench/report writes them.
//
// libjpeg reports errors through callbacks that must not return. It is C, so no exception may pass through it: the
// callback jumps back instead. A caller keeps objects with destructors out of the frame that is jumped over:
//
//   bool decode(JpegErrors& errors, jpeg_decompress_struct& info, ...) {  // plain data only
//     if (setjmp(errors.returnPoint) != 0) return false;                  // and errors.message says why
#pragma once

#include <csetjmp>
#include <cstddef>
#include <cstdio>
// After <cstdio>: jpeglib.h uses FILE without declaring it.
#include <jpeglib.h>

namespace wavecrest {

struct JpegErrors {
  jpeg_error_mgr manager{};  // first member: libjpeg hands back a pointer to it
  std::jmp_buf returnPoint{};
  char message[JMSG_LENGTH_MAX]{};

  JpegErrors() {
    jpeg_std_error(&manager);
    manager.error_exit = &leave;
    manager.emit_message = &leaveOnWarning;
  }

 private:
  static void leave(j_common_ptr info) {
    auto* errors = reinterpret_cast<JpegErrors*>(info->err);
    errors->manager.format_message(info, errors->message);
    std::longjmp(errors->returnPoint, 1);
  }
  // Warnings mean damaged data that libjpeg would paper over in grey.
  static void leaveOnWarning(j_common_ptr info, int level) {
    if (level < 0) leave(info);
  }
};

}  // namespace wavecrest
