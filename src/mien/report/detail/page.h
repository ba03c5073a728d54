#pragma once
/// The page, section by section; each returns markup, empty when there is nothing to say.

#include <string>

#include "mien/report/detail/data.h"
#include "mien/report/detail/portrait.h"

namespace mien::detail {

/// What the sections read and draw with.
struct PageInput {
  const ReportInput& input;
  const Data& data;
  const Portrait &source, &target;
  const Portrait* thesis = nullptr;  ///< none: there is no baseline
};

/// Goes above `sections`, the markup of all others, and links to them.
std::string overview_section(const PageInput& page, const std::string& sections);
std::string surfaces_section(const PageInput& page);
std::string maps_section(const PageInput& page);
std::string shapes_section(const PageInput& page);
std::string baseline_section(const PageInput& page);
std::string weights_section(const PageInput& page);
std::string clips_section(const PageInput& page);
std::string pieces_section(const PageInput& page);
std::string seconds_section(const PageInput& page);

}  // namespace mien::detail
