/// What the engine asks of the system besides threads (`parallel.h`): memory. The system's own, or a web page's.
#pragma once

#include <cstddef>

namespace hedon {

/// Zeroed memory, in large pages where the system has them; null if it refuses. Pages that are never touched cost
/// nothing where the system allows that.
void* reserve_pages(size_t bytes);

/// Gives memory back that `reserve_pages` gave.
void release_pages(void* block, size_t bytes);

}  // namespace hedon
