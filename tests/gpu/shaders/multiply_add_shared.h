// The push constants of multiply_add.comp, for both languages.
#ifndef MULTIPLY_ADD_SHARED_H
#define MULTIPLY_ADD_SHARED_H
#ifdef __cplusplus
#include <cstdint>
using uint = std::uint32_t;
#endif
struct MultiplyAdd {
    uint count;
    uint factor;
    uint summand;
};
#endif
