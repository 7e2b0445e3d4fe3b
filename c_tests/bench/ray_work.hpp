// What rays meet, and what answering them takes.
#pragma once

#include <string>

#include "backend/backend.hpp"
#include "bench/results.hpp"
#include "rays/rays.hpp"

namespace harness {

/// The means over the closest hits of all rays, of shadow rays too.
RayWork mean_work(Backend& backend, const RaySet& set);

/// Without rays of a batch.
RaySetInfo ray_set_info(const std::string& view, const RaySet& set, Backend& backend);

}  // namespace harness
