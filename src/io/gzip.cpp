#include "io/gzip.h"

#include <zlib.h>

#include <algorithm>
#include <limits>
#include <new>

#include "base/error.h"

namespace aspic {
namespace {

constexpr int kGzipWindow = 15 + 16;  // largest window; 16 selects gzip's header and trailer [zlib.h, deflateInit2]
constexpr int kMemoryLevel = 8;       // zlib's default
constexpr size_t kGzipChunk = size_t{1} << 16;

// zlib counts in 32 bits, so the input is passed in portions.
void hand_over(z_stream& stream, std::string_view& rest) {
  if (stream.avail_in > 0) return;
  const size_t portion = std::min<size_t>(rest.size(), std::numeric_limits<uInt>::max());
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(rest.data()));  // zlib does not write to it
  stream.avail_in = static_cast<uInt>(portion);
  rest.remove_prefix(portion);
}

// Provides room for another chunk at the end of `bytes`; `take_back` removes the unused part.
void add_room(z_stream& stream, std::string& bytes) {
  bytes.resize(bytes.size() + kGzipChunk);
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data() + bytes.size() - kGzipChunk);
  stream.avail_out = kGzipChunk;
}

void take_back(const z_stream& stream, std::string& bytes) { bytes.resize(bytes.size() - stream.avail_out); }

}  // namespace

std::string gzipped(std::string_view bytes) {
  z_stream stream = {};
  if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, kGzipWindow, kMemoryLevel, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::bad_alloc();
  std::string packed;
  for (int status = Z_OK; status != Z_STREAM_END;) {
    hand_over(stream, bytes);
    add_room(stream, packed);
    status = deflate(&stream, bytes.empty() ? Z_FINISH : Z_NO_FLUSH);
    take_back(stream, packed);
  }
  deflateEnd(&stream);
  return packed;
}

std::string gunzipped(std::string_view bytes, size_t limit) {
  z_stream stream = {};
  if (inflateInit2(&stream, kGzipWindow) != Z_OK) throw std::bad_alloc();
  std::string unpacked;
  int status = Z_OK;
  while (status == Z_OK && unpacked.size() <= limit) {
    hand_over(stream, bytes);
    add_room(stream, unpacked);
    status = inflate(&stream, Z_NO_FLUSH);
    take_back(stream, unpacked);
  }
  const bool has_rest = stream.avail_in > 0 || !bytes.empty();
  inflateEnd(&stream);
  if (status == Z_MEM_ERROR) throw std::bad_alloc();
  if (unpacked.size() > limit)
    throw InvalidInput("gzip: unpacks to more than the " + std::to_string(limit) + " bytes that were expected");
  if (status == Z_BUF_ERROR) throw InvalidInput("gzip: the data is cut short");
  if (status != Z_STREAM_END || has_rest) throw InvalidInput("gzip: the data is damaged");
  return unpacked;
}

}  // namespace aspic
