"""Generates the engine's list of gene-set numbers: `python -m hedon.config.settable > engine/config/settable.h`."""

import sys

from hedon.config.expression import CONVERTED, engine_name, limits_of, settable

_HEADER = """\
/// The numbers of a species that genes may set, as `src/hedon/config/expression.py` finds them.
/// This file is written by `uv run python -m hedon.config.settable > engine/config/settable.h`. Do not edit it.
// clang-format off
#pragma once

#include <cstdint>

#include "base/device.h"
#include "config/schema.h"

namespace hedon {

HEDON_ENUM(GenomeSet, %s)

/// A number that a gene sets, with its limits.
struct SettableNumber {
  float* number;
  float low, high;
};

/// Where a species has the number that genes of this name set; what is converted has no such place.
HEDON_FN SettableNumber settable(SpeciesConfig& config, GenomeSet which, int32_t store) {
  StoreConfig& own = store == 0 ? config.energy : config.store.items[store - 1];
  switch (which) {
%s
  }
  return {nullptr, 0.0f, 0.0f};
}

}  // namespace hedon
"""


def header() -> str:
    """The whole header."""
    cases = []
    for path, (low, high) in ((path, limits_of(path)) for path in settable()):
        reference = path.replace("store.<kind>", "own") if path.startswith("store.") else f"config.{path}"
        statement = "break" if path in CONVERTED else f"return {{&{reference}, {float(low)!r}f, {float(high)!r}f}}"
        cases.append(f"    case GenomeSet::{engine_name(path)}: {statement};")
    return _HEADER % (",\n      ".join(map(engine_name, settable())), "\n".join(cases))


if __name__ == "__main__":
    sys.stdout.write(header())
