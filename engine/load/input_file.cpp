#include "engine/load/input_file.h"

#include <zlib.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <memory>
#include <system_error>

namespace wavecrest {

namespace {

// A zlib stream that expects gzip data; the destructor frees it.
struct Inflater {
  z_stream stream{};
  bool ok = false;
  Inflater() { ok = inflateInit2(&stream, 15 + 16) == Z_OK; }  // 15: window of 32 KiB; +16: expect a gzip header
  ~Inflater() { inflateEnd(&stream); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;
};

bool isGzip(const std::vector<char>& bytes) { return bytes.size() >= 2 && bytes[0] == '\x1f' && bytes[1] == '\x8b'; }

// The inflated content of a gzip file; `name` is the file for errors. LoadError if the data is damaged, truncated, or
// larger than the limits allow.
std::vector<char> inflateAll(const std::vector<char>& compressed, const std::string& name) {
  const SourceLocation inFile{name, 0};
  Inflater inflater;
  if (!inflater.ok) throw LoadError(inFile, "cannot start zlib; expected enough memory for its window");
  z_stream& stream = inflater.stream;
  // The limit grows with the compressed size, which stops bombs. The extra 1 MiB lets small, repetitive files pass.
  const size_t largest = std::min(kLargestInflated, kHighestRatio * compressed.size() + (size_t{1} << 20));
  // Start with the room that most files need; the loop enlarges it where they need more.
  std::vector<char> out(std::min(largest, compressed.size() * 5));
  size_t consumed = 0, produced = 0;
  for (;;) {
    // zlib counts in 32 bits: hand it slices.
    constexpr size_t kSlice = std::numeric_limits<uInt>::max() / 2;
    stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(compressed.data() + consumed));
    stream.avail_in = static_cast<uInt>(std::min(kSlice, compressed.size() - consumed));
    stream.next_out = reinterpret_cast<Bytef*>(out.data() + produced);
    stream.avail_out = static_cast<uInt>(std::min(kSlice, out.size() - produced));
    // Inflate one slice, and count what went in and what came out.
    const uInt given = stream.avail_in, room = stream.avail_out;
    const int status = inflate(&stream, Z_NO_FLUSH);
    consumed += given - stream.avail_in;
    produced += room - stream.avail_out;
    if (status == Z_STREAM_END) {
      if (consumed == compressed.size()) break;
      // Concatenated gzip members are one stream.
      if (inflateReset(&stream) != Z_OK) throw LoadError(inFile, "cannot restart zlib; expected one gzip stream");
      continue;
    }
    // Z_BUF_ERROR means that zlib needs more input or more room. The checks below find out which.
    if (status != Z_OK && status != Z_BUF_ERROR) {
      throw LoadError(inFile, "damaged gzip data after " + std::to_string(produced) + " bytes (" +
                                  (stream.msg ? stream.msg : "zlib error") + "); expected an intact .gz file");
    }
    // A full buffer grows up to the limit. If there is room but no input left, the stream is truncated.
    if (produced == out.size()) {
      if (out.size() >= largest) {
        throw LoadError(inFile, "inflates to more than " + std::to_string(largest) +
                                    " bytes; expected a smaller or an uncompressed file");
      }
      out.resize(std::min(largest, out.size() * 2));
    } else if (consumed == compressed.size()) {
      throw LoadError(inFile, "truncated gzip data: ends after " + std::to_string(produced) +
                                  " inflated bytes; expected an intact .gz file");
    }
  }
  out.resize(produced);
  return out;
}

std::vector<char> readAllOfStandardInput(size_t limit) {
  std::vector<char> bytes;
  // The length of standard input is not known in advance: read pieces of 64 KiB until nothing comes.
  for (size_t count = 1; count > 0;) {
    const size_t done = bytes.size();
    bytes.resize(done + (size_t{1} << 16));
    count = std::fread(bytes.data() + done, 1, bytes.size() - done, stdin);
    bytes.resize(done + count);
    if (bytes.size() > limit) {
      throw LoadError({kStandardInput, 0}, "standard input is longer than expected, at most " + std::to_string(limit) +
                                               " bytes; expected a scene");
    }
  }
  if (std::ferror(stdin)) throw LoadError({kStandardInput, 0}, "cannot read standard input; expected a scene");
  return isGzip(bytes) ? inflateAll(bytes, kStandardInput) : bytes;
}

}  // namespace

// Campaigns and `bench --tradeoff` load a scene more than once.
std::vector<char> readStandardInput(size_t limit) {
  static const std::vector<char> bytes = readAllOfStandardInput(limit);
  return bytes;
}

std::vector<char> readInputFile(const std::filesystem::path& path, const SourceLocation& where, size_t limit) {
  const std::string name = path.string();
  std::error_code error;
  // Refuse everything but a regular file: opening a FIFO could block forever.
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    throw MissingFileError(where, path);
  }
  if (!std::filesystem::is_regular_file(status)) {
    throw LoadError(where, "\"" + name + "\" is not a regular file; expected a file, not a directory or a device");
  }
  // Compare the size with the limit before memory is allocated.
  const uintmax_t size = std::filesystem::file_size(path, error);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(name.c_str(), "rb"), &std::fclose);
  if (error || !file) throw LoadError(where, "cannot open \"" + name + "\"; expected a readable file");
  if (size > limit) {
    throw LoadError(
        where, "\"" + name + "\" has " + std::to_string(size) + " bytes; expected at most " + std::to_string(limit));
  }
  // Read the content, and inflate it if it is compressed.
  std::vector<char> bytes(static_cast<size_t>(size));
  if (std::fread(bytes.data(), 1, bytes.size(), file.get()) != bytes.size()) {
    throw LoadError(where, "cannot read all of \"" + name + "\"; expected " + std::to_string(size) + " bytes");
  }
  return isGzip(bytes) ? inflateAll(bytes, name) : bytes;
}

}  // namespace wavecrest
