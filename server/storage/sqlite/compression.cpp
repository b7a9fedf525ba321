#include "server/storage/sqlite/compression.h"

#include <zstd.h>

#include <memory>
#include <string>

#include "server/storage/sqlite/storage_error.h"

namespace vat {
namespace {

constexpr int kLevel = 1;  // numbers of a simulation hardly shrink more at higher ones

struct FreeContext {
  void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
};

std::size_t check(std::size_t result) {
  if (ZSTD_isError(result) == 0) return result;
  throw StorageError(StorageError::Kind::corrupt,
                     std::string("compressed bytes: ") + ZSTD_getErrorName(result));
}

}  // namespace

std::vector<std::uint8_t> compress(std::span<const std::uint8_t> bytes) {
  const std::unique_ptr<ZSTD_CCtx, FreeContext> context(ZSTD_createCCtx());
  check(ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, kLevel));
  check(ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1));
  std::vector<std::uint8_t> frame(ZSTD_compressBound(bytes.size()));
  frame.resize(
      check(ZSTD_compress2(context.get(), frame.data(), frame.size(), bytes.data(), bytes.size())));
  return frame;
}

std::vector<std::uint8_t> decompress(std::span<const std::uint8_t> frame, std::size_t max_bytes) {
  const unsigned long long size = ZSTD_getFrameContentSize(frame.data(), frame.size());
  if (size == ZSTD_CONTENTSIZE_ERROR || size == ZSTD_CONTENTSIZE_UNKNOWN || size > max_bytes) {
    throw StorageError(StorageError::Kind::corrupt, "compressed bytes: no size, or too large");
  }
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
  const std::size_t got =
      check(ZSTD_decompress(bytes.data(), bytes.size(), frame.data(), frame.size()));
  if (got != bytes.size()) {
    throw StorageError(StorageError::Kind::corrupt, "compressed bytes: fewer than stated");
  }
  return bytes;
}

}  // namespace vat
