/// Hashes of bytes: they only have to distinguish states and find damage, not to resist an attacker.
#pragma once

#include <cstdint>
#include <cstring>

namespace hedon {

/// Multiply and shift, eight bytes at a time.
class Hash {
 public:
  void add(const char* from, size_t bytes) {
    mix(bytes);
    add_words(from, bytes);
  }
  /// Does not include the number of bytes. Of consecutive pieces, all but the last must be whole words.
  void add_words(const char* from, size_t bytes) {
    for (size_t at = 0; at < bytes; at += 8) {
      uint64_t word = 0;
      memcpy(&word, from + at, bytes - at < 8 ? bytes - at : 8);
      mix(word);
    }
  }
  void mix(uint64_t word) {
    value_ = (value_ ^ word) * 0xD6E8FEB86659FD93u;
    value_ ^= value_ >> 32;
  }
  uint64_t value() const { return value_; }

 private:
  uint64_t value_ = 0x9E3779B97F4A7C15u;
};

/// The hash of many bytes, in four parallel chains, since a single chain waits for each multiplication.
inline uint64_t hash_bytes(const char* from, size_t bytes) {
  Hash chain[4];
  const size_t whole = bytes / 32 * 32;
  for (size_t at = 0; at < whole; at += 32) {
    uint64_t word[4];
    memcpy(word, from + at, sizeof word);
    for (int c = 0; c < 4; ++c) chain[c].mix(word[c]);
  }
  Hash all;
  all.add(from + whole, bytes - whole);
  for (const Hash& each : chain) all.mix(each.value());
  return all.value();
}

}  // namespace hedon
