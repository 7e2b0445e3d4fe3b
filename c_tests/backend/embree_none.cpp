// What a program built without Embree says about it.
#ifndef GNOMON_WITH_EMBREE

#include "backend/backend.hpp"

namespace harness {

std::unique_ptr<Backend> make_embree(const Scene&, bool, std::uint32_t, std::uint32_t) { return nullptr; }

bool embree_takes(const GnomonRay&) { return false; }
bool embree_takes(const Scene&) { return false; }

std::string embree_version() { return ""; }

}  // namespace harness

#endif
