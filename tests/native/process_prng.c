// Unpredictable bytes, as in bcryptprimitives.dll of Windows since 2009 and of Wine since version 9.
#include <stddef.h>

__declspec(dllimport) unsigned char SystemFunction036(void* bytes, unsigned long count);  // RtlGenRandom

__declspec(dllexport) int ProcessPrng(unsigned char* bytes, size_t count) {
  while (count > 0) {
    const unsigned long part = count > 1u << 30 ? 1u << 30 : (unsigned long)count;
    if (!SystemFunction036(bytes, part)) return 0;
    bytes += part;
    count -= part;
  }
  return 1;
}
