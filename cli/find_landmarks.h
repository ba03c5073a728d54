#pragma once
/// Landmarks for the commands that need them and were given few or none.

#include <string>

#include "command.h"
#include "mien/transfer/find_landmarks.h"

namespace mien::cli {

/// `find_landmarks`, where a refusal is an error that names the file and says why.
FoundLandmarks find_landmarks_of(const std::string& file, const Character& target, const Character& like,
                                 const FindLandmarksOptions& options);

/// What was found, for people (one line and one a doubtful point) and for programs.
std::string text_of(const FoundLandmarks& found);
nlohmann::json json_of(const FoundLandmarks& found);

}  // namespace mien::cli
