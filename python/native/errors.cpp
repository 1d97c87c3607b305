// api::Error as the exceptions of wavecrest.errors, with file and line.
#include "native.h"

namespace wavecrest::python {

nb::str toText(const std::string& text) {
  PyObject* const decoded = PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "replace");
  if (decoded == nullptr) throw nb::python_error();
  return nb::steal<nb::str>(decoded);
}

namespace {

const char* className(api::ErrorKind kind) {
  switch (kind) {
    case api::ErrorKind::usage:
      return "UsageError";
    case api::ErrorKind::input:
      return "InputError";
    case api::ErrorKind::fault:
      break;
  }
  return "FaultError";
}

void raise(const api::Error& error) {
  const nb::object type = nb::module_::import_("wavecrest.errors").attr(className(error.kind()));
  const nb::object file = error.file().empty() ? nb::none() : nb::object(toText(error.file()));
  const nb::object line = error.line() == 0 ? nb::none() : nb::object(nb::int_(error.line()));
  PyErr_SetObject(type.ptr(), type(toText(error.what()), file, line).ptr());
}

}  // namespace

void addErrors(nb::module_&) {
  nb::register_exception_translator([](const std::exception_ptr& thrown, void*) {
    try {
      std::rethrow_exception(thrown);
    } catch (const api::Error& error) {
      raise(error);
    }
  });
}

}  // namespace wavecrest::python
