/* bcryptprimitives.dll, which every Windows since 8 has and wine before 9 has not. Rust's standard library takes seeds of hash tables
 * from it. For tests under wine; never shipped. */
#include <windows.h>
#include <ntsecapi.h>

__declspec(dllexport) BOOL WINAPI ProcessPrng(PBYTE data, SIZE_T length) {
    return RtlGenRandom(data, (ULONG)length);
}
