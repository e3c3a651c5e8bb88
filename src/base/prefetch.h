// A hint to the processor that memory will be read soon: a batch of paths asks for what all of them need before it
// works on the first.
#pragma once

namespace lumel {

// Never faults, whatever the address.
inline void prefetch(const void* address) { __builtin_prefetch(address); }

}  // namespace lumel
