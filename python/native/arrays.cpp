#include "native.h"

namespace wavecrest::python {
namespace {

template <class Number>
nb::object ownedArray(std::vector<Number> numbers, std::initializer_list<size_t> shape) {
  auto* const owned = new std::vector<Number>(std::move(numbers));
  const nb::capsule owner(owned, [](void* vector) noexcept { delete static_cast<std::vector<Number>*>(vector); });
  return nb::cast(nb::ndarray<nb::numpy, Number>(owned->data(), shape, owner));
}

}  // namespace

nb::object floatArray(std::vector<float> numbers, std::initializer_list<size_t> shape) {
  return ownedArray(std::move(numbers), shape);
}

nb::object byteArray(std::vector<uint8_t> numbers, std::initializer_list<size_t> shape) {
  return ownedArray(std::move(numbers), shape);
}

api::Image toImage(const FloatImage& pixels, bool srgb) {
  return {.width = static_cast<uint32_t>(pixels.shape(1)),
          .height = static_cast<uint32_t>(pixels.shape(0)),
          .pixels = {pixels.data(), pixels.data() + pixels.size()},
          .srgb = srgb};
}

}  // namespace wavecrest::python
