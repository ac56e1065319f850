/// The threads of a CUDA block as the group that every step rule is written for: see `base/team.h`.
#pragma once

namespace hedon {

class Block {
 public:
  __device__ int rank() const { return static_cast<int>(threadIdx.x); }
  __device__ int size() const { return static_cast<int>(blockDim.x); }
  __device__ void barrier() const { __syncthreads(); }

  /// Calls body(i) for i in [0, count), neighbors in neighboring threads.
  template <class Body>
  __device__ void for_each(int count, Body&& body) const {
    for (int i = rank(); i < count; i += size()) body(i);
    barrier();
  }

  /// Threads need not take the same branch here.
  template <class Body>
  __device__ void for_each_backward(int count, Body&& body) const {
    for_each(count, body);
  }

  template <class Body>
  __device__ void for_each_claimed(int count, Body&& body) const {
    for_each(count, body);
  }

  template <class Body>
  __device__ void once(Body&& body) const {
    if (rank() == 0) body();
    barrier();
  }
};

}  // namespace hedon
