#pragma once

#include <string>
#include <vector>

#include "html/page.hpp"

namespace hybrid_sphere::html {

/// The data of a page, an object of JSON, and what it leaves out.
struct PageData {
  std::string json;
  std::vector<std::string> left_out;
};

/// @param room  bytes that it may have
PageData page_data(const scene::Scene& scene, const Recording& recording, const PageText& text,
                   std::size_t room);

}  // namespace hybrid_sphere::html
