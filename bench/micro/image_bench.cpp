// Writing an EXR beside compressing it: what the file, its flush to the device and the order of its blocks cost.
//
// Both use OpenEXR's ZIP coder on its own threads, all cores. Compression alone goes to a stream that drops its bytes.
// Each iteration compresses, writes, and compares the two, so that other programs on the machine disturb both alike.
// Time is that of writing. `ratio` is the median of writing / compression over the iterations; `least_ratio` is the
// shortest time of each. The file lies in the folder that TMPDIR names, and is read back before anything is timed.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfThreading.h>
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/statistics/medians.h"
#include "metrics/image/image_io.h"

namespace wavecrest {
namespace {

// Smooth light with a tenth of noise in all bits of the mantissa, as a render has after a hundred samples.
Image noisyImage(uint32_t side) {
  Image image{side, side, 3, {}};
  image.pixels.resize(size_t{3} * side * side);
  uint32_t state = 1;
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    state = state * 1664525u + 1013904223u;
    const float noise = static_cast<float>(state >> 8) * 0x1p-24f;
    const size_t pixel = i / 3, row = pixel / side, column = pixel % side;
    const float x = static_cast<float>(column) / static_cast<float>(side);
    const float y = static_cast<float>(row) / static_cast<float>(side);
    image.pixels[i] = (0.2f + x * y) * (0.95f + 0.1f * noise);
  }
  return image;
}

// Takes all bytes and keeps none.
class Nowhere : public Imf::OStream {
 public:
  Nowhere() : Imf::OStream("nowhere") {}
  void write(const char[], int count) override {
    position_ += static_cast<uint64_t>(count);
    bytes_ = std::max(bytes_, position_);
  }
  uint64_t tellp() override { return position_; }
  void seekp(uint64_t position) override { position_ = position; }
  uint64_t bytes() const { return bytes_; }

 private:
  uint64_t position_ = 0, bytes_ = 0;
};

// Size of the file that writeExr writes, without metadata.
uint64_t compressAlone(const Image& image) {
  Imf::Header header(static_cast<int>(image.width), static_cast<int>(image.height));
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::FrameBuffer frame;
  for (size_t c = 0; c < 3; ++c) {
    const std::string name(1, "RGB"[c]);
    char* base = reinterpret_cast<char*>(const_cast<float*>(image.pixels.data() + c));  // is only read
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    frame.insert(name, Imf::Slice(Imf::FLOAT, base, 3 * sizeof(float), 3 * sizeof(float) * image.width));
  }
  Nowhere stream;
  {
    Imf::OutputFile output(stream, header, Imf::globalThreadCount());
    output.setFrameBuffer(frame);
    output.writePixels(static_cast<int>(image.height));
  }
  return stream.bytes();
}

template <class Work>
double secondsOf(Work&& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void writeExrBesideCompression(benchmark::State& state) {
  namespace fs = std::filesystem;
  const Image image = noisyImage(static_cast<uint32_t>(state.range(0)));
  const std::string file =
      (fs::temp_directory_path() / ("image_bench." + std::to_string(::getpid()) + ".exr")).string();
  writeExr(file, image);
  const uint64_t size = fs::file_size(file);
  if (readImage(file).image.pixels != image.pixels || compressAlone(image) != size) {
    state.SkipWithError("the file does not hold the image, or not as it is compressed here");
    return;
  }
  std::vector<double> ratios;
  double leastCompressing = INFINITY, leastWriting = INFINITY;
  for (auto _ : state) {
    const double compressing = secondsOf([&] { compressAlone(image); });
    const double writing = secondsOf([&] { writeExr(file, image); });
    state.SetIterationTime(writing);
    ratios.push_back(writing / compressing);
    leastCompressing = std::min(leastCompressing, compressing);
    leastWriting = std::min(leastWriting, writing);
  }
  fs::remove(file);
  state.SetItemsProcessed(static_cast<int64_t>(state.iterations()) * state.range(0) * state.range(0));
  state.counters["MB"] = static_cast<double>(size) / 1e6;
  state.counters["compression_s"] = leastCompressing;
  state.counters["ratio"] = median(ratios);
  state.counters["least_ratio"] = leastWriting / leastCompressing;
}
void timedByItself(benchmark::internal::Benchmark* benchmark) {
  benchmark->UseManualTime()->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);
}
BENCHMARK(writeExrBesideCompression)->Apply(timedByItself)->Arg(1024);
// Long: on two cores each iteration compresses for a quarter of a minute, twice.
BENCHMARK(writeExrBesideCompression)->Apply(timedByItself)->Arg(8192)->Iterations(3);

}  // namespace
}  // namespace wavecrest
