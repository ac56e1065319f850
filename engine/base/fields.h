/// One list of fields per struct. The engine uses it to fill configs and to allocate, save and bind states.
///
/// Write `HEDON_FIELDS(SolverConfig, dt, passes)` as the last line of a struct without padding. If a field is missing
/// from the list, the sizes differ and the code does not compile.
#pragma once

#include <cstddef>

#define HEDON_PARENS ()
#define HEDON_EXPAND(...) HEDON_EXPAND3(HEDON_EXPAND3(HEDON_EXPAND3(HEDON_EXPAND3(__VA_ARGS__))))
#define HEDON_EXPAND3(...) HEDON_EXPAND2(HEDON_EXPAND2(HEDON_EXPAND2(HEDON_EXPAND2(__VA_ARGS__))))
#define HEDON_EXPAND2(...) HEDON_EXPAND1(HEDON_EXPAND1(HEDON_EXPAND1(HEDON_EXPAND1(__VA_ARGS__))))
#define HEDON_EXPAND1(...) __VA_ARGS__
#define HEDON_EACH(macro, type, ...) __VA_OPT__(HEDON_EXPAND(HEDON_EACH_STEP(macro, type, __VA_ARGS__)))
#define HEDON_EACH_STEP(macro, type, first, ...) \
  macro(type, first) __VA_OPT__(HEDON_EACH_AGAIN HEDON_PARENS(macro, type, __VA_ARGS__))
#define HEDON_EACH_AGAIN() HEDON_EACH_STEP

#define HEDON_SIZE_OF(type, field) +sizeof(type::field)
#define HEDON_VISIT(type, field) visit(#field, &type::field);

#define HEDON_UNPACK(...) __VA_ARGS__
#define HEDON_CALL(macro, ...) macro(__VA_ARGS__)
#define HEDON_SIZE_OF_ARRAY_(type, field, rows, width, lifetime) +sizeof(type::field)
#define HEDON_SIZE_OF_ARRAY(type, item) HEDON_CALL(HEDON_SIZE_OF_ARRAY_, type, HEDON_UNPACK item)
#define HEDON_VISIT_ARRAY_(type, field, rows, width, lifetime) visit(#field, &type::field);
#define HEDON_VISIT_ARRAY(type, item) HEDON_CALL(HEDON_VISIT_ARRAY_, type, HEDON_UNPACK item)
#define HEDON_VISIT_SHAPE_(type, field, rows, width, lifetime) \
  visit(#field, &type::field, ArrayShape{Extent::rows, Extent::width, Lifetime::lifetime});
#define HEDON_VISIT_SHAPE(type, item) HEDON_CALL(HEDON_VISIT_SHAPE_, type, HEDON_UNPACK item)

/// Gives `Type::for_each_field(visit)`, which calls `visit(name, &Type::field)` for each field in order.
#define HEDON_FIELDS(Type, ...)                                                           \
  template <class Visit>                                                                  \
  static constexpr void for_each_field(Visit&& visit) {                                   \
    static_assert(sizeof(Type) == (0 HEDON_EACH(HEDON_SIZE_OF, Type, __VA_ARGS__)),       \
                  "HEDON_FIELDS of " #Type " misses a field, or the struct has padding"); \
    HEDON_EACH(HEDON_VISIT, Type, __VA_ARGS__)                                            \
  }

/// The list of a struct of arrays: for each (field, rows, width, lifetime), names of `Extent` and `Lifetime`. Gives
/// `for_each_field`, as above, and `for_each_shape(visit)`, which calls visit(name, &Type::field, ArrayShape).
#define HEDON_ARRAYS(Type, ...)                                                                 \
  template <class Visit>                                                                        \
  static void for_each_field(Visit&& visit) {                                                   \
    static_assert(sizeof(Type) == (0 HEDON_EACH(HEDON_SIZE_OF_ARRAY, Type, __VA_ARGS__)),       \
                  "HEDON_ARRAYS of " #Type " misses an array, or the struct has other fields"); \
    HEDON_EACH(HEDON_VISIT_ARRAY, Type, __VA_ARGS__)                                            \
  }                                                                                             \
  template <class Visit>                                                                        \
  static void for_each_shape(Visit&& visit) {                                                   \
    HEDON_EACH(HEDON_VISIT_SHAPE, Type, __VA_ARGS__)                                            \
  }
