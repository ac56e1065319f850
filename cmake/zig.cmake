# Compiles with Zig's Clang, for any system: cmake --toolchain cmake/zig.cmake -DHEDON_ZIG=… -DHEDON_TARGET=…
#   HEDON_ZIG     the program `zig`; by default that of the package ziglang of `Python_EXECUTABLE`
#   HEDON_TARGET  such as aarch64-linux-musl, aarch64-macos, x86_64-macos; by default x86_64-windows-gnu
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES HEDON_ZIG HEDON_TARGET)
if(NOT HEDON_TARGET)
  set(HEDON_TARGET x86_64-windows-gnu)
endif()
if(NOT HEDON_ZIG)
  execute_process(COMMAND "${Python_EXECUTABLE}" -c
    "import pathlib, shutil, ziglang; print(shutil.which('zig', path=pathlib.Path(ziglang.__file__).parent))"
    OUTPUT_STRIP_TRAILING_WHITESPACE OUTPUT_VARIABLE HEDON_ZIG COMMAND_ERROR_IS_FATAL ANY)
endif()
string(REGEX MATCH "^[^-]+" CMAKE_SYSTEM_PROCESSOR "${HEDON_TARGET}")
if(HEDON_TARGET MATCHES "macos")
  set(CMAKE_SYSTEM_NAME Darwin)
elseif(HEDON_TARGET MATCHES "windows")
  set(CMAKE_SYSTEM_NAME Windows)
else()
  set(CMAKE_SYSTEM_NAME Linux)
endif()
set(CMAKE_CXX_COMPILER "${HEDON_ZIG}" c++ -target "${HEDON_TARGET}")
# The archives of this machine's `ar` would have no index of another system's symbols.
set(CMAKE_CXX_ARCHIVE_CREATE "\"${HEDON_ZIG}\" ar qc <TARGET> <OBJECTS>")
set(CMAKE_CXX_ARCHIVE_APPEND "\"${HEDON_ZIG}\" ar q <TARGET> <OBJECTS>")
set(CMAKE_CXX_ARCHIVE_FINISH "\"${HEDON_ZIG}\" ranlib <TARGET>")
