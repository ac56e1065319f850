/// What a program of XLA calls: it hands the memory of a call to the engine. Compiled on first use against the headers of
/// the jaxlib that is there, since their layout changes with it.
#include <cstdint>

#include "xla/ffi/api/ffi.h"

namespace ffi = xla::ffi;

using Step = void (*)(const int64_t* call, void* const* in, void* const* out, int64_t rows, char* complaint, int64_t room);

/// What each buffer must hold: rows of `width` numbers of a type.
struct Expected {
  const char* name;
  ffi::DataType type;
  int64_t width;
};

static bool fits(const ffi::AnyBuffer& buffer, const Expected& expected, int64_t rows) {
  return buffer.element_type() == expected.type &&
         static_cast<int64_t>(buffer.element_count()) == rows * expected.width;
}

static ffi::Error refuse(const Expected& expected) {
  return ffi::Error::InvalidArgument(std::string("hedon: ") + expected.name + ": is of another type or shape");
}

static ffi::Error step(ffi::RemainingArgs args, ffi::RemainingRets rets, ffi::Span<const int64_t> call) {
  constexpr size_t NUMBERS = 9, INPUTS = 6, OUTPUTS = 7;
  if (call.size() != NUMBERS || args.size() != INPUTS || rets.size() != OUTPUTS)
    return ffi::Error::InvalidArgument("hedon: this program was made by another version of hedon");
  const int64_t slots = call[6], entries = call[7];
  const Expected inputs[INPUTS] = {{"state.world", ffi::S32, 1},
                                   {"state.turn", ffi::U32, 1},
                                   {"key", ffi::U32, 2},
                                   {"state.agent_id", ffi::S32, slots},
                                   {"action", ffi::F32, 2 * slots},
                                   {"params.max_steps", ffi::S32, 1}};
  const Expected outputs[OUTPUTS] = {{"world", ffi::S32, 1},       {"turn", ffi::U32, 1},
                                     {"agent_id", ffi::S32, slots}, {"observation", ffi::F32, slots * entries},
                                     {"reward", ffi::F32, slots},   {"terminated", ffi::PRED, slots},
                                     {"done", ffi::PRED, 1}};
  void* in[INPUTS];
  void* out[OUTPUTS];
  int64_t rows = 0;
  for (size_t i = 0; i < INPUTS; ++i) {
    auto buffer = args.get<ffi::AnyBuffer>(i);
    if (!buffer.has_value()) return buffer.error();
    if (i == 0) rows = static_cast<int64_t>(buffer->element_count());
    if (!fits(*buffer, inputs[i], rows)) return refuse(inputs[i]);
    in[i] = buffer->untyped_data();
  }
  for (size_t i = 0; i < OUTPUTS; ++i) {
    auto buffer = rets.get<ffi::AnyBuffer>(i);
    if (!buffer.has_value()) return buffer.error();
    if (!fits(**buffer, outputs[i], rows)) return refuse(outputs[i]);
    out[i] = (*buffer)->untyped_data();
  }
  char complaint[600];
  reinterpret_cast<Step>(static_cast<uintptr_t>(call[0]))(call.begin(), in, out, rows, complaint, sizeof complaint);
  return complaint[0] == 0 ? ffi::Error::Success() : ffi::Error::InvalidArgument(std::string("hedon: ") + complaint);
}

XLA_FFI_DEFINE_HANDLER_SYMBOL(hedon_step, step,
                              ffi::Ffi::Bind().RemainingArgs().RemainingRets().Attr<ffi::Span<const int64_t>>("call"));
