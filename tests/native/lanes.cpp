/// A million random operations of one lane type and of the processor's own floats, many at the border of denormal
/// numbers: compares each with a reference and prints a hash per operation, which must be the same on all machines.
///
/// Compile it with -DHEDON_LANES='"lanes/avx2.h"' and -DHEDON_FUSES=1 (0 for portable lanes). If a result is wrong,
/// exits with status 1 and a message.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iterator>

#include HEDON_LANES
#include "base/float_mode.h"
#include "base/random.h"

namespace hedon {
namespace {

constexpr uint32_t BLOCKS = 1 << 16;
constexpr int WIDTH = 16;
constexpr double SMALLEST = 0x1p-126;          ///< smallest normal float
constexpr double BELOW = SMALLEST - 0x1p-151;  ///< from here on, x86 rounds up to SMALLEST before it flushes
#if defined(__x86_64__)
constexpr float BETWEEN = 0x1p-126f;  ///< what a result in between becomes
#else
constexpr float BETWEEN = 0.0f;
#endif

struct Block {
  alignas(64) float at[WIDTH];
};

float from_bits(uint32_t bits) {
  float x;
  memcpy(&x, &bits, sizeof x);
  return x;
}
uint32_t bits_of(float x) {
  uint32_t bits;
  memcpy(&bits, &x, sizeof bits);
  if (x != x) return 0x7fc00000u;                                // sign and payload of a NaN depend on the machine
  return (bits & 0x7f800000u) == 0 ? bits & 0x80000000u : bits;  // a denormal number is read as 0
}
/// As the processor reads it: a denormal number is 0.
double read(float x) { return std::fabs(static_cast<double>(x)) < SMALLEST ? std::copysign(0.0, x) : x; }

struct Hash {
  uint64_t value = 0xcbf29ce484222325;
  void add(uint64_t x) {
    for (int i = 0; i < 8; ++i, x >>= 8) value = (value ^ (x & 255)) * 0x100000001b3;
  }
};

[[noreturn]] void fail(const char* name, float a, float b, float c, float found, float wanted) {
  printf("%s of %a, %a, %a is %a instead of %a\n", name, static_cast<double>(a), static_cast<double>(b),
         static_cast<double>(c), static_cast<double>(found), static_cast<double>(wanted));
  exit(1);
}

/// A number with an exponent in this range and either sign.
float draw(uint32_t word, int lowest, int highest) {
  const uint32_t exponent = static_cast<uint32_t>(lowest + 127) + to_index(word << 9, uint32_t(highest - lowest + 1));
  return from_bits((word & 0x807fffffu) | exponent << 23);
}

/// Factors whose product is next to the smallest normal number: 2^-63·m and about 2^-63/m.
void draw_border(const uint32_t* word, float* a, float* b) {
  const float m = from_bits((word[0] & 0x7fffffu) | 0x3f800000u);
  const uint32_t bits = bits_of(static_cast<float>(0x1p-63 / static_cast<double>(m)));
  *a = m * 0x1p-63f * ((word[1] & 1) ? 1.0f : -1.0f);
  *b = from_bits(bits + (word[1] >> 1) % 5 - 2);
}

constexpr float SPECIAL[] = {0.0f, -0.0f,     0x1p-130f,  -0x1.8p-127f,    INFINITY, -INFINITY,
                             NAN,  0x1p-126f, -0x1p-126f, 0x1.fffffep127f, 1.0f};

/// Operands of a block: ordinary ones, products and sums at the border, and special ones.
void draw_block(uint32_t index, Block* a, Block* b, Block* c) {
  for (int i = 0; i < WIDTH; ++i) {
    const RandomStream random{7, Purpose::network, static_cast<uint32_t>(i), index};
    const Random4 r = random.draw(0);
    switch (r.word[3] % 8) {
      case 0:
        a->at[i] = SPECIAL[r.word[0] % std::size(SPECIAL)];
        b->at[i] = SPECIAL[r.word[1] % std::size(SPECIAL)];
        c->at[i] = SPECIAL[r.word[2] % std::size(SPECIAL)];
        break;
      case 1:
      case 2:
        draw_border(r.word, &a->at[i], &b->at[i]);
        c->at[i] = (r.word[2] & 1) ? 0.0f : draw(r.word[2], -126, -122);
        break;
      case 3:  // sums of the smallest numbers, quotients and products around the border
        a->at[i] = draw(r.word[0], -126, -124);
        b->at[i] = draw(r.word[1], -126, -124);
        c->at[i] = draw(r.word[2], -2, 2);
        break;
      case 4:
        a->at[i] = draw(r.word[0], -66, -60);
        b->at[i] = draw(r.word[1], -66, -60);
        c->at[i] = draw(r.word[2], -126, -120);
        break;
      case 5:
        a->at[i] = draw(r.word[0], -124, -60);
        b->at[i] = draw(r.word[1], 0, 64);
        c->at[i] = draw(r.word[2], -126, -20);
        break;
      default:
        a->at[i] = draw(r.word[0], -8, 8);
        b->at[i] = draw(r.word[1], -8, 8);
        c->at[i] = draw(r.word[2], -8, 8);
    }
  }
}

/// Whether x86 and ARM differ if the exact result is `x` + `rest`, with |rest| less than a unit of x.
bool is_between(double x, double rest) {
  const double size = std::fabs(x), more = x < 0 ? -rest : rest;
  return (size > BELOW || (size == BELOW && more >= 0)) && (size < SMALLEST || (size == SMALLEST && more < 0));
}

/// The same for a product, or a product and a sum. The product of two floats is exact in double.
bool is_between(float a, float b, float c) {
  const double product = read(a) * read(b), other = read(c);
  const double total = product + other, back = total - product;
  return is_between(total, (product - (total - back)) + (other - back));
}

/// Hashes a result; if machines differ, compares it with the value required on this one instead.
void take(Hash* hash, const char* name, bool between, float found, float a, float b, float c, int64_t* differing) {
  if (!between) {
    hash->add(bits_of(found));
    return;
  }
  ++*differing;
  if (std::fabs(found) != BETWEEN) fail(name, a, b, c, found, BETWEEN);
}

float fused(float a, float b, float c) {
#if HEDON_FUSES
  return __builtin_fmaf(a, b, c);
#else
  return a * b + c;
#endif
}

struct Operation {
  const char* name;
  Lanes (*lanes)(Lanes a, Lanes b, Lanes c);
  float (*one)(float a, float b, float c);  ///< the reference
  int terms;                                ///< 2 or 3 if the result is a product or a fused multiply-add; otherwise 0
};

const Operation OPERATIONS[] = {
    {"add", [](Lanes a, Lanes b, Lanes) { return a + b; }, [](float a, float b, float) { return a + b; }, 0},
    {"subtract", [](Lanes a, Lanes b, Lanes) { return a - b; }, [](float a, float b, float) { return a - b; }, 0},
    {"multiply", [](Lanes a, Lanes b, Lanes) { return a * b; }, [](float a, float b, float) { return a * b; }, 2},
    {"divide", [](Lanes a, Lanes b, Lanes) { return a / b; }, [](float a, float b, float) { return a / b; }, 0},
    {"multiply_add", [](Lanes a, Lanes b, Lanes c) { return multiply_add(a, b, c); }, fused, HEDON_FUSES ? 3 : 0},
    {"square_root", [](Lanes a, Lanes, Lanes) { return square_root(a); },
     [](float a, float, float) { return __builtin_sqrtf(a); }, 0},
    {"smaller", [](Lanes a, Lanes b, Lanes) { return smaller(a, b); },
     [](float a, float b, float) { return a < b ? a : b; }, 0},
    {"larger", [](Lanes a, Lanes b, Lanes) { return larger(a, b); },
     [](float a, float b, float) { return a > b ? a : b; }, 0},
    {"less", [](Lanes a, Lanes b, Lanes c) { return select(a < b, c, a); },
     [](float a, float b, float c) { return a < b ? c : a; }, 0},
    {"less_or_equal", [](Lanes a, Lanes b, Lanes c) { return select(a <= b, c, b); },
     [](float a, float b, float c) { return a <= b ? c : b; }, 0},
    {"both", [](Lanes a, Lanes b, Lanes c) { return select(both(a < b, b <= c), c, a); },
     [](float a, float b, float c) { return a < b && b <= c ? c : a; }, 0},
    {"lower_half", [](Lanes a, Lanes, Lanes) { return lower_half(a); },
     [](float a, float, float) {
       uint32_t bits;
       memcpy(&bits, &a, sizeof bits);
       return from_bits(bits << 16);
     },
     0},
    {"scale_exponent",
     [](Lanes, Lanes b, Lanes) {
       return scale_exponent(broadcast(1.5f),
                             broadcast(12582912.0f) + smaller(broadcast(100), larger(b, broadcast(-100))));
     },
     [](float, float b, float) {
       const float shifted = 12582912.0f + (b > -100 ? (b < 100 ? b : 100) : -100);
       return std::ldexp(1.5f, static_cast<int>(shifted - 12582912.0f));
     },
     0},
};

void try_operation(const Operation& operation) {
  Hash hash;
  int64_t differing = 0;
  for (uint32_t n = 0; n < BLOCKS; ++n) {
    Block a, b, c, out;
    draw_block(n, &a, &b, &c);
    store(out.at, operation.lanes(load(a.at), load(b.at), load(c.at)));
    for (int i = 0; i < WIDTH; ++i) {
      const float x = a.at[i], y = b.at[i], z = c.at[i], wanted = operation.one(x, y, z);
      if (bits_of(out.at[i]) != bits_of(wanted)) fail(operation.name, x, y, z, out.at[i], wanted);
      const bool between = operation.terms > 0 && is_between(x, y, operation.terms == 3 ? z : 0.0f);
      take(&hash, operation.name, between, out.at[i], x, y, z, &differing);
    }
  }
  printf("%s %016llx %lld\n", operation.name, static_cast<unsigned long long>(hash.value),
         static_cast<long long>(differing));
}

/// Operations that do not return lanes: sums, bits of masks, indices, bytes.
void try_reductions() {
  Hash hash;
  for (uint32_t n = 0; n < BLOCKS; ++n) {
    Block a, b, c;
    draw_block(n, &a, &b, &c);
    uint32_t bits = 0;
    float half[WIDTH];
    memcpy(half, c.at, sizeof half);
    for (int i = 0; i < WIDTH; ++i) bits |= (a.at[i] < b.at[i] ? 1u : 0u) << i;
    for (int width = WIDTH / 2; width > 0; width /= 2) {
      for (int i = 0; i < width; ++i) half[i] += half[i + width];
    }
    const LaneMask mask = load(a.at) < load(b.at);
    if (to_bits(mask) != bits || any(mask) != (bits != 0)) fail("to_bits", 0, 0, 0, float(to_bits(mask)), float(bits));
    const float total = sum(load(c.at));
    if (bits_of(total) != bits_of(half[0])) fail("sum", 0, 0, 0, total, half[0]);
    const int32_t count = static_cast<int32_t>(n % (WIDTH + 1));
    if (to_bits(first_lanes(count)) != (1u << count) - 1u) fail("first_lanes", float(count), 0, 0, 0, 0);
    int32_t index[WIDTH], seen = 0;
    const int32_t written = write_indices(index, 1000, bits);
    for (int i = 0; i < WIDTH; ++i) {
      if ((bits >> i & 1) == 0) continue;
      if (seen >= written || index[seen] != 1000 + i) fail("write_indices", float(i), 0, 0, 0, 0);
      ++seen;
    }
    if (seen != written) fail("write_indices", 0, 0, 0, float(written), float(seen));
    for (int i = 0; i < WIDTH; ++i) c.at[i] = static_cast<float>((n * 31 + static_cast<uint32_t>(i) * 17) % 256);
    uint8_t bytes[WIDTH];
    store_bytes(bytes, load(c.at));
    for (int i = 0; i < WIDTH; ++i) {
      if (float(bytes[i]) != c.at[i]) fail("store_bytes", c.at[i], 0, 0, float(bytes[i]), c.at[i]);
    }
    hash.add(bits);
    hash.add(bits_of(total));
  }
  printf("reductions %016llx 0\n", static_cast<unsigned long long>(hash.value));
}

/// The processor's own floats and doubles, with which the rules of a world are computed.
void try_scalars() {
  Hash sums, quotients, roots, narrow, wide;
  int64_t differing = 0;
  for (uint32_t n = 0; n < BLOCKS; ++n) {
    Block a, b, c;
    draw_block(n, &a, &b, &c);
    for (int i = 0; i < WIDTH; ++i) {
      const volatile float x = a.at[i], y = b.at[i];  // volatile: the compiler must not compute the results
      sums.add(bits_of(x + y));
      sums.add(bits_of(x - y));
      quotients.add(bits_of(x / y));
      roots.add(bits_of(__builtin_sqrtf(x)));
      const volatile double p = static_cast<double>(x) * static_cast<double>(y);
      take(&narrow, "narrow", is_between(p, 0.0), static_cast<float>(p), x, y, 0, &differing);
      // A double's own border is at 2^-1022.
      const volatile double tiny = static_cast<double>(x) * 0x1p-900, small = static_cast<double>(y) * 0x1p-60;
      const double results[] = {tiny + small * 0x1p-840, tiny - small * 0x1p-840, tiny / (1.0 / small)};
      for (const double result : results) wide.add(result != result ? 1 : double_to_bits(result));
    }
  }
  const Hash* const all[] = {&sums, &quotients, &roots, &narrow, &wide};
  const char* const names[] = {"float_sums", "float_quotients", "float_roots", "narrow", "double"};
  for (int i = 0; i < 5; ++i)
    printf("%s %016llx %lld\n", names[i], static_cast<unsigned long long>(all[i]->value),
           static_cast<long long>(i == 3 ? differing : 0));
}

}  // namespace
}  // namespace hedon

int main() {
  const hedon::FloatMode mode;
  for (const hedon::Operation& operation : hedon::OPERATIONS) hedon::try_operation(operation);
  hedon::try_reductions();
  hedon::try_scalars();
  return 0;
}
