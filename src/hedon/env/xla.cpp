/// What a program of XLA calls: it hands the memory of a call to the engine. Compiled on first use against the headers of
/// the jaxlib that is there, since their layout changes with it.
#include <cstdint>

#include "xla/ffi/api/ffi.h"

namespace ffi = xla::ffi;

using Step = void (*)(const int64_t* call, void* const* in, void* const* out, int64_t rows, char* complaint, int64_t room);

static ffi::Error step(ffi::RemainingArgs args, ffi::RemainingRets rets, ffi::Span<const int64_t> call) {
  constexpr size_t MOST = 8;
  void* in[MOST];
  void* out[MOST];
  if (args.size() > MOST || rets.size() > MOST || args.size() == 0) return ffi::Error::InvalidArgument("hedon: buffers");
  int64_t rows = 0;
  for (size_t i = 0; i < args.size(); ++i) {
    auto buffer = args.get<ffi::AnyBuffer>(i);
    if (!buffer.has_value()) return buffer.error();
    if (i == 0) rows = static_cast<int64_t>(buffer->element_count());
    in[i] = buffer->untyped_data();
  }
  for (size_t i = 0; i < rets.size(); ++i) {
    auto buffer = rets.get<ffi::AnyBuffer>(i);
    if (!buffer.has_value()) return buffer.error();
    out[i] = (*buffer)->untyped_data();
  }
  char complaint[600];
  reinterpret_cast<Step>(static_cast<uintptr_t>(call[0]))(call.begin(), in, out, rows, complaint, sizeof complaint);
  return complaint[0] == 0 ? ffi::Error::Success() : ffi::Error::InvalidArgument(std::string("hedon: ") + complaint);
}

XLA_FFI_DEFINE_HANDLER_SYMBOL(hedon_step, step,
                              ffi::Ffi::Bind().RemainingArgs().RemainingRets().Attr<ffi::Span<const int64_t>>("call"));
