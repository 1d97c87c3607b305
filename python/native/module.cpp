// wavecrest._native: the C++ interface as it is. What people import is the package around it, python/wavecrest.
#include "native.h"

NB_MODULE(_native, module) {
  module.doc() = "The C++ side of wavecrest.";
  module.attr("version") = wavecrest::api::version();
  module.attr("commit") = wavecrest::api::commit();
  wavecrest::python::addErrors(module);
  wavecrest::python::addRender(module);
  wavecrest::python::addCompare(module);
  wavecrest::python::addCampaign(module);
}
