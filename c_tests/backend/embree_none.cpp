// What a program built without Embree says about it.
#ifndef GNOMON_WITH_EMBREE

#include "backend/backend.hpp"

namespace harness {

std::unique_ptr<Backend> make_embree(const Scene&, bool, std::uint32_t, std::uint32_t) { return nullptr; }

std::string embree_version() { return ""; }

}  // namespace harness

#endif
