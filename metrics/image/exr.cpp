// OpenEXR, single part, scan lines or tiles. Files are decoded from memory, so that one place checks lengths. They are
// written as they are compressed, and renamed at the end as those of every other format.
#include <ImathBox.h>
#include <OpenEXR/IlmThreadPool.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>
#include <half.h>
#include <oneapi/tbb/info.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <exception>
#include <list>
#include <memory>
#include <mutex>
#include <new>
#include <system_error>

#include "metrics/image/atomic_file.h"
#include "metrics/image/codecs.h"
#include "metrics/image/exr_colour.h"
#include "metrics/image/image_io.h"

namespace wavecrest {
namespace {

// ---- streams over memory --------------------------------------------------------------------------------------------

// The bytes of an EXR file as OpenEXR reads them. A read past the end throws std::runtime_error.
class MemoryInput : public Imf::IStream {
 public:
  MemoryInput(const std::string& path, codecs::Bytes bytes) : Imf::IStream(path.c_str()), bytes_(bytes) {}
  bool read(char out[], int count) override {
    const auto wanted = static_cast<uint64_t>(count);
    if (count < 0 || position_ > bytes_.size() || wanted > bytes_.size() - position_)
      throw std::runtime_error("the file ends early");
    std::memcpy(out, bytes_.data() + position_, wanted);
    position_ += wanted;
    return position_ < bytes_.size();
  }
  uint64_t tellg() override { return position_; }
  void seekg(uint64_t position) override { position_ = position; }

 private:
  codecs::Bytes bytes_;
  uint64_t position_ = 0;
};

// The file that OpenEXR writes. Its bytes come in order except for the table of blocks, which OpenEXR fills in last.
// Devices and pipes take bytes in order only, so they receive the whole file in commit().
class FileOutput : public Imf::OStream {
 public:
  static constexpr size_t kBuffer = size_t{1} << 22;

  explicit FileOutput(const std::string& path) : Imf::OStream(path.c_str()), file_(path) {}
  void write(const char data[], int count) override {
    const auto size = static_cast<size_t>(count);
    if (waiting_.size() < position_ - begin_ + size) waiting_.resize(position_ - begin_ + size);
    std::memcpy(waiting_.data() + (position_ - begin_), data, size);
    position_ += size;
    if (file_.isSeekable() && waiting_.size() >= kBuffer) flush();
  }
  uint64_t tellp() override { return position_; }
  void seekp(uint64_t position) override {
    // Waiting bytes are contiguous, so they are written before the position changes.
    if (file_.isSeekable()) {
      flush();
      kept([&] { file_.seek(position); });
      begin_ = position;
    }
    position_ = position;
  }
  void commit() {
    if (failure_) std::rethrow_exception(failure_);
    flush();
    file_.commit();
  }

 private:
  // Calls f. An error is thrown, and kept for commit() as well: OpenEXR's destructors drop errors.
  template <class F>
  void kept(F f) {
    try {
      f();
    } catch (...) {
      failure_ = std::current_exception();
      throw;
    }
  }
  void flush() {
    kept([&] { file_.write(waiting_); });
    begin_ += waiting_.size();
    waiting_.clear();
  }

  AtomicFile file_;
  std::vector<unsigned char> waiting_;  // from begin_ on
  uint64_t begin_ = 0, position_ = 0;
  std::exception_ptr failure_;  // OpenEXR keeps what is thrown while it closes a file to itself
};

// ---- threads --------------------------------------------------------------------------------------------------------

// Gives out the blocks of all files that OpenEXR reads and writes. It has no threads until setNumThreads(), and none in
// a forked child of the process that has them: there each block is done at once by the thread that brings it. OpenEXR's
// own pool would wait for threads that do not exist in a child, even with 0 threads for the file, and again at exit.
class BlockPool : public IlmThread::ThreadPoolProvider {
 public:
  int numThreads() const override {
    const IlmThread::ThreadPool* pool = threads();
    return pool != nullptr ? pool->numThreads() : 0;
  }
  // Where memory or processes are short, as many of them as start: the calling thread does what none of them can.
  void setNumThreads(int count) override {
    const std::lock_guard lock(starting_);
    if (process_ == 0) {
      threads_ = new IlmThread::ThreadPool(0);
      process_ = ::getpid();
    }
    IlmThread::ThreadPool* pool = threads();
    if (pool == nullptr) return;
    try {
      for (int n = std::min(count, pool->numThreads() + 1); n <= count; ++n) pool->setNumThreads(n);
    } catch (const std::system_error&) {
    }
  }
  void addTask(IlmThread::Task* task) override {
    if (IlmThread::ThreadPool* pool = threads()) {
      pool->addTask(task);
      return;
    }
    IlmThread::TaskGroup* group = task->group();
    task->execute();
    delete task;
    group->finishOneTask();
  }
  // OpenEXR deletes the pool after this. A child leaves its parent's threads_ as they are, for they cannot be joined.
  void finish() override { delete threads(); }

 private:
  // Null where there are none.
  IlmThread::ThreadPool* threads() const { return process_ == ::getpid() ? threads_ : nullptr; }

  std::mutex starting_;
  IlmThread::ThreadPool* threads_ = nullptr;  // set before process_
  std::atomic<pid_t> process_ = 0;            // where the threads are
};

// A pool whose threads the program has started before stays.
void useBlockPoolOnce() {
  static std::once_flag once;
  std::call_once(once, [] {
    if (Imf::globalThreadCount() == 0) IlmThread::ThreadPool::globalThreadPool().setThreadProvider(new BlockPool);
  });
}

// Compression dominates the time of a write; blocks are compressed by a pool of threads, as many as TBB has for
// metrics: one for each processor of the affinity mask. The bytes do not depend on their number.
int compressionThreads() {
  useBlockPoolOnce();
  static std::once_flag once;
  std::call_once(once, [] {
    if (Imf::globalThreadCount() == 0) Imf::setGlobalThreadCount(oneapi::tbb::info::default_concurrency());
  });
  return std::max(1, Imf::globalThreadCount());  // a forked child has none, and compresses by itself
}

// A header may claim any size; beyond these OpenEXR refuses before it allocates.
void setLimitsOnce() {
  constexpr int kLongestSide = 1 << 20, kLongestTileSide = 1 << 13;
  static std::once_flag once;
  std::call_once(once, [] {
    Imf::Header::setMaxImageSize(kLongestSide, kLongestSide);
    Imf::Header::setMaxTileSize(kLongestTileSide, kLongestTileSide);
  });
}

// ---- reading --------------------------------------------------------------------------------------------------------

// The first 16 channel names of a file, for error messages.
std::string listChannels(const Imf::ChannelList& channels) {
  std::string list;
  int count = 0;
  for (auto it = channels.begin(); it != channels.end(); ++it) {
    if (++count > 16) return list + " ...";
    list += (list.empty() ? "" : " ") + codecs::quoted(it.name());
  }
  return list.empty() ? "none" : list;
}

// The pixels of a layer in Rec. 709, always with three channels. An empty name is the main image.
Image readLayer(const std::string& path, Imf::InputFile& input, uint64_t fileBytes, const std::string& layer) {
  const Imf::ChannelList& channels = input.header().channels();
  const auto [colour, names] = codecs::findExrChannels(channels, layer);
  if (names.empty()) {
    const std::string wanted = layer.empty() ? "R G B, X Y Z, Y RY BY or Y" : "a layer '" + layer + "'";
    throw ImageError(path, "EXR channels are: " + listChannels(channels), "expected " + wanted);
  }
  // Only chroma may have fewer samples than pixels.
  for (size_t c = 0; c < names.size(); ++c) {
    const Imf::Channel& channel = channels[names[c].c_str()];
    const bool chroma = colour == codecs::ExrColour::lumaChroma && c > 0;
    if (!chroma && (channel.xSampling != 1 || channel.ySampling != 1))
      throw ImageError(path, "EXR channel " + names[c] + " is subsampled", "expected a sample for every pixel");
  }

  // In 64 bits, as the corners of a damaged window may be further apart than an int can tell.
  const Imath::Box2i window = input.header().dataWindow();
  const auto width = static_cast<uint64_t>(int64_t{window.max.x} - window.min.x + 1);
  const auto height = static_cast<uint64_t>(int64_t{window.max.y} - window.min.y + 1);
  // A sample has at least two bytes. DWAA and DWAB shrink at most about 33,000 times, the other coders less than 4096
  // times.
  const size_t full = colour == codecs::ExrColour::lumaChroma ? 1 : names.size();
  codecs::checkSize(path, width, height, 0, 0);
  codecs::checkSize(path, width, height, width * height * 2 * full / 65536, fileBytes);

  // OpenEXR converts every sample type to float, and interleaves the channels through the strides.
  Image image{static_cast<uint32_t>(width), static_cast<uint32_t>(height), 3, {}};
  image.pixels.resize(width * height * 3);
  Imf::FrameBuffer frame;
  std::list<codecs::ExrChannelTarget> targets;
  for (size_t c = 0; c < names.size(); ++c) {
    targets.emplace_back(channels[names[c].c_str()], image, c);
    frame.insert(names[c], targets.back().slice(window));
  }
  input.setFrameBuffer(frame);
  input.readPixels(window.min.y, window.max.y);
  for (const codecs::ExrChannelTarget& target : targets) target.spread();
  codecs::convertExrColour(path, input.header(), colour, image);
  return image;
}

// The string attributes of a header by name.
Metadata stringAttributes(const Imf::Header& header) {
  Metadata metadata;
  for (auto it = header.begin(); it != header.end(); ++it) {
    if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute())) {
      metadata[it.name()] = text->value();
    }
  }
  return metadata;
}

// Opens a file. OpenEXR allocates the blocks that the header announces before their size can be checked, so that a lack
// of memory may mean a damaged header here.
std::unique_ptr<Imf::InputFile> openExr(const std::string& path, Imf::IStream& stream) {
  try {
    return std::make_unique<Imf::InputFile>(stream, 0);
  } catch (const std::bad_alloc&) {
    throw ImageError(path, "blocks of the EXR header's size do not fit into memory",
                     "expected an intact EXR file, or more memory");
  }
}

// One layer of a file in memory. Errors of OpenEXR become ImageErrors.
ImageFile readLayerAndMetadata(const std::string& path, codecs::Bytes bytes, const std::string& layer) {
  try {
    setLimitsOnce();
    useBlockPoolOnce();
    codecs::checkExrHeader(path, bytes);
    MemoryInput stream(path, bytes);
    const std::unique_ptr<Imf::InputFile> input = openExr(path, stream);
    ImageFile file;
    file.image = readLayer(path, *input, bytes.size(), layer);
    file.metadata = stringAttributes(input->header());
    const Imath::Box2i& window = input->header().dataWindow();
    file.corner = {window.min.x, window.min.y};
    return file;
  } catch (const ImageError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw ImageError(path, std::string("OpenEXR error: ") + error.what(), "expected an intact EXR file");
  }
}

// ---- writing --------------------------------------------------------------------------------------------------------

constexpr int kBlockRows = 16;  // of ZIP_COMPRESSION

// Rows that each thread compresses between two reports of progress. Threads wait for each other before a report, so
// reports must not be frequent.
constexpr int kRowsAtOnce = 16 * kBlockRows;

// Gives OpenEXR the samples of a file: the images' own floats, or halves made of them. The halves live as long as this
// object.
class ChannelSource {
 public:
  ChannelSource(const std::string& path, ExrSamples samples) : path_(path), samples_(samples) {}

  void add(Imf::Header& header, Imf::FrameBuffer& frame, const Image& image, const std::string& prefix) {
    if (samples_ == ExrSamples::floats) {
      // FrameBuffer has no const form; writing only reads through it.
      addChannels(header, frame, const_cast<float*>(image.pixels.data()), Imf::FLOAT, image, prefix);
    } else {
      addChannels(header, frame, halvesOf(image).data(), Imf::HALF, image, prefix);
    }
  }

 private:
  // Declares the channels of one image in the header, and tells OpenEXR where their samples are.
  template <class Sample>
  static void addChannels(Imf::Header& header, Imf::FrameBuffer& frame, Sample* samples, Imf::PixelType type,
                          const Image& image, const std::string& prefix) {
    const std::vector<std::string> names =
        image.channels == 1 ? std::vector<std::string>{"Y"} : std::vector<std::string>{"R", "G", "B"};
    for (size_t c = 0; c < names.size(); ++c) {
      const size_t xStride = image.channels * sizeof(Sample);
      header.channels().insert(prefix + names[c], Imf::Channel(type));
      frame.insert(prefix + names[c],
                   Imf::Slice(type, reinterpret_cast<char*>(samples + c), xStride, xStride * image.width));
    }
  }

  // An image's samples as halves. Throws ImageError for a sample beyond the largest half.
  std::vector<Imath::half>& halvesOf(const Image& image) {
    std::vector<Imath::half>& halves = halves_.emplace_back(image.pixels.begin(), image.pixels.end());
    for (const float sample : image.pixels) {
      if (std::abs(sample) > kLargestHalf)
        throw ImageError(path_, "a sample is " + std::to_string(sample), "expected at most 65504, the largest half");
    }
    return halves;
  }

  const std::string& path_;
  const ExrSamples samples_;
  std::list<std::vector<Imath::half>> halves_;
};

}  // namespace

ImageFile codecs::decodeExr(const std::string& path, Bytes bytes) { return readLayerAndMetadata(path, bytes, ""); }

Image codecs::decodeExrLayer(const std::string& path, Bytes bytes, const std::string& layer) {
  return readLayerAndMetadata(path, bytes, layer).image;
}

size_t exrWritingBytes(uint32_t width, uint32_t height) {
  // OpenEXR has two blocks for each thread, and of each block the rows, their reordered bytes and what these become.
  const size_t rowBytes = size_t{3} * sizeof(float) * width, threads = static_cast<size_t>(compressionThreads());
  const size_t blocks = std::min((size_t{height} + kBlockRows - 1) / kBlockRows, 2 * threads);
  return 3 * blocks * kBlockRows * rowBytes + 2 * std::min(FileOutput::kBuffer, rowBytes * height);
}

void writeExr(const std::string& path, const Image& image, const Metadata& metadata, std::span<const ExrLayer> layers,
              const WriteProgress& progress, ExrSamples samples) {
  try {
    // Header and channels.
    Imf::Header header(static_cast<int>(image.width), static_cast<int>(image.height));
    header.compression() = Imf::ZIP_COMPRESSION;
    // Halves are for files that are kept: slower, and some percent smaller.
    if (samples == ExrSamples::halves) header.zipCompressionLevel() = 9;
    for (const auto& [key, value] : metadata) header.insert(key, Imf::StringAttribute(value));
    Imf::FrameBuffer frame;
    ChannelSource source(path, samples);
    source.add(header, frame, image, "");
    for (const ExrLayer& layer : layers) {
      if (layer.image.width != image.width || layer.image.height != image.height)
        throw ImageError(path, "EXR layer '" + layer.name + "' differs in size", "expected the main image's size");
      source.add(header, frame, layer.image, layer.name + ".");
    }
    // OutputFile writes the table of blocks in its destructor, so the block ends before the commit.
    FileOutput stream(path);
    {
      const int threads = compressionThreads(), height = static_cast<int>(image.height);
      Imf::OutputFile output(stream, header, threads);
      output.setFrameBuffer(frame);
      for (int done = 0; done < height;) {
        const int rows = std::min(kRowsAtOnce * threads, height - done);
        output.writePixels(rows);
        done += rows;
        if (progress) progress(static_cast<double>(done) / height);
      }
    }
    stream.commit();
  } catch (const ImageError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw ImageError(path, std::string("OpenEXR error: ") + error.what(), "expected an image that can be written");
  }
}

}  // namespace wavecrest
