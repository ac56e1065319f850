/// Islands: groups of bodies that may touch one another until the next build. Islands are divided into independent
/// batches.
#pragma once

#include <cstdint>

#include "physics/state.h"

namespace hedon {

/// Root of the island of a rank; halves the path to it.
HEDON_FN int32_t find_root(const Array<int32_t>& parent, int32_t rank) {
  while (parent[rank] != rank) {
    parent[rank] = parent[parent[rank]];
    rank = parent[rank];
  }
  return rank;
}

/// Joins two islands; the lower rank becomes the root.
HEDON_FN void join(const Array<int32_t>& parent, int32_t a, int32_t b) {
  a = find_root(parent, a);
  b = find_root(parent, b);
  if (a < b)
    parent[b] = a;
  else
    parent[a] = b;
}

/// Number of batches for this number of bodies: enough for several threads, each large enough to keep one busy.
HEDON_FN int32_t batch_count(int32_t bodies) {
  const int32_t wanted = bodies / 16;
  return wanted < 1 ? 1 : (wanted > MAX_BATCHES ? MAX_BATCHES : wanted);
}

/// Gives each rank its index: batch by batch, and by rank within a batch. Islands go to batches in the order of
/// their lowest rank, so that the batches have nearly equal work if no single island is larger than its share.
/// scratch.parent   joined islands
/// scratch.work     pairs by first rank on entry; overwritten
HEDON_FN void assign_indices(NeighborHead& head, const PhysicsScratch& scratch, int32_t bodies) {
  int64_t total = bodies;
  for (int32_t rank = 0; rank < bodies; ++rank) {
    const int32_t pairs = scratch.work[rank];
    const int32_t root = find_root(scratch.parent, rank);
    total += pairs;
    // The root has the lowest rank of its island, so its own entry is complete before others add to it.
    if (root == rank)
      scratch.work[rank] = pairs + 1;
    else
      scratch.work[root] += pairs + 1;
    scratch.batch[rank] = -1;
  }
  const int32_t batches = batch_count(bodies);
  int32_t size[MAX_BATCHES] = {};
  int64_t done = 0;
  for (int32_t rank = 0; rank < bodies; ++rank) {
    const int32_t root = find_root(scratch.parent, rank);
    if (root == rank) {
      scratch.batch[root] = static_cast<int32_t>(done * batches / total);
      done += scratch.work[root];
    }
    ++size[scratch.batch[root]];
  }
  head.bodies = bodies;
  head.batches = batches;
  head.batch_start[0] = 0;
  int32_t next[MAX_BATCHES];
  for (int32_t batch = 0; batch < batches; ++batch) {
    next[batch] = head.batch_start[batch];
    head.batch_start[batch + 1] = next[batch] + size[batch];
  }
  for (int32_t rank = 0; rank < bodies; ++rank) {
    scratch.new_index[rank] = next[scratch.batch[find_root(scratch.parent, rank)]]++;
  }
}

}  // namespace hedon
