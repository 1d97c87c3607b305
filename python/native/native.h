// What the files of the native module share. Each function here adds its part to the module.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <string>

#include "wavecrest/wavecrest.h"

namespace wavecrest::python {

namespace nb = nanobind;

using FloatImage = nb::ndarray<const float, nb::shape<-1, -1, 3>, nb::c_contig, nb::device::cpu>;
using FloatMap = nb::ndarray<const float, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

// ---- arrays.cpp -----------------------------------------------------------------------------------------------------

// The numbers of a vector as an array of this shape, not copied: the array owns them from then on.
nb::object floatArray(std::vector<float> numbers, std::initializer_list<size_t> shape);
nb::object byteArray(std::vector<uint8_t> numbers, std::initializer_list<size_t> shape);
// One copy, of which the comparison becomes the owner.
api::Image toImage(const FloatImage& pixels, bool srgb);

// ---- errors.cpp -----------------------------------------------------------------------------------------------------

// Bytes that are no UTF-8, as scene files may have them, become U+FFFD.
nb::str toText(const std::string& text);

// ---- parts of the module --------------------------------------------------------------------------------------------

void addErrors(nb::module_& module);
void addRender(nb::module_& module);
void addCompare(nb::module_& module);
void addCampaign(nb::module_& module);

}  // namespace wavecrest::python
