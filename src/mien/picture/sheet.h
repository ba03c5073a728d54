#pragma once
/// Contact sheets: a grid of labelled pictures.

#include <string>
#include <vector>

#include "mien/picture/picture.h"

namespace mien {

struct SheetCell {
  std::string label;    ///< under the picture, in bold; shortened to the cell's width
  Picture picture;      ///< centred in the cell; without pixels the cell stays empty
  std::string caption;  ///< a second line, or none
};

struct SheetOptions {
  std::string title;   ///< above, or none
  std::string footer;  ///< below, or none
  int columns = 0;     ///< 0: by count, so that the sheet is about 1.5 times as wide as high
};

/// The cells in reading order. All cells are as large as the largest picture.
///   throws  invalid_input: no cells; a sheet with a side above `max_picture_side`
Picture contact_sheet(const std::vector<SheetCell>& cells, const SheetOptions& options = {});

}  // namespace mien
