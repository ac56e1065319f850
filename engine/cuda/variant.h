/// The variants of the kernels: the same arithmetic in the same order, divided differently over threads and memory.
///
/// A library has one of them, `VARIANT`; what the others need is not compiled. `tests/device.py --variants` builds,
/// checks and times each.
#pragma once

#include <cstdint>

namespace hedon {

struct Variant {
  const char* name;
  int32_t threads;    ///< of a block
  int32_t tile_rows;  ///< samples or rows of the tiles that a thread computes in an update
  int32_t moments;    ///< most moments of Adam that an update keeps in shared memory; the others stay in global memory
  int32_t together;   ///< blocks that a multiprocessor must have registers for, which limits a thread's; 0 for no limit
  int32_t learners;   ///< blocks of updates that a multiprocessor works on at the same time
  bool compact;       ///< an update keeps no gradient and no transposed copy of the square layer in shared memory
  bool fetch;         ///< the weights of an agent are fetched while it observes
  int32_t staged;     ///< bodies whose substeps have room in shared memory, with as many pairs of each kind
  bool overlap;       ///< groups of worlds, of which one steps while another one learns; not known to the kernels
};

/// The list that `--variants` reads: each name is a value of HEDON_VARIANT.
namespace variant {
inline constexpr Variant shared_moments{"shared_moments", 512, 2, 2, 0, 1, false, false, 0, false};
inline constexpr Variant fetched_weights{"fetched_weights", 512, 2, 2, 0, 1, false, true, 0, false};
inline constexpr Variant shared_bodies{"shared_bodies", 512, 2, 2, 0, 1, false, false, 384, false};
inline constexpr Variant global_moments{"global_moments", 512, 2, 0, 0, 1, false, false, 0, false};
inline constexpr Variant half_blocks{"half_blocks", 256, 4, 0, 2, 1, false, false, 0, false};
inline constexpr Variant overlap{"overlap", 256, 4, 0, 2, 1, false, false, 0, true};
inline constexpr Variant two_learners{"two_learners", 256, 4, 0, 2, 2, true, false, 0, false};
inline constexpr Variant overlap_two_learners{"overlap_two_learners", 256, 4, 0, 2, 2, true, false, 0, true};
}  // namespace variant

/// The variant of a build that names none: the fastest of those measured on a device.
#if !defined(HEDON_VARIANT)
#define HEDON_VARIANT shared_moments
#endif
inline constexpr Variant VARIANT = variant::HEDON_VARIANT;

/// Threads of a block, also of the emulated ones unless a test asks for fewer.
#if defined(HEDON_BLOCK_THREADS)
inline constexpr int32_t BLOCK_THREADS = HEDON_BLOCK_THREADS;
#else
inline constexpr int32_t BLOCK_THREADS = VARIANT.threads;
#endif

/// Most groups of worlds.
inline constexpr int32_t MAX_GROUPS = 8;

}  // namespace hedon
