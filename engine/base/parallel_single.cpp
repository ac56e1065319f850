/// The pool where there are no threads: WebAssembly without shared memory. The caller does all the work.
#if defined(__wasm__)

#include "base/parallel.h"

namespace hedon {

int available_processors() { return 1; }

struct Pool::Shared {};

Pool::Pool(int, bool) : size_(1), process_(0) {}
Pool::~Pool() = default;
bool Pool::forked() const { return false; }
void Pool::run(const std::function<void(int)>& job) { job(0); }

}  // namespace hedon

#endif
