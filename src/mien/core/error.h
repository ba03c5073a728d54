#pragma once
/// The one error type of mien.
///
/// Every function of the library reports a failure by throwing `Error`. Its text is one line in the form
/// `place: what is wrong; what would be right`; `in_file` puts the file's name in front of it, and the
/// command line puts `mien: ` in front of that. A poor result (a fit that is far off, an iteration that did
/// not converge) is not an error: it is a field of the result.

#include <stdexcept>
#include <string>
#include <string_view>

namespace mien {

class Error : public std::runtime_error {
 public:
  enum class Kind {
    invalid_input,  ///< the caller's data cannot be used: wrong size, not finite, unknown name, singular set
    io,             ///< a file cannot be read or written, or is not of its format
    cancelled,      ///< a `Progress` asked to stop
  };

  /// `place` names where ("landmark noseTip", "accessor 12", "line 40"); `problem` says what is wrong there;
  /// `remedy` what would be right. Empty parts are left out of the text.
  Error(Kind kind, std::string_view place, std::string_view problem, std::string_view remedy = {});

  Kind kind() const { return kind_; }

  /// The same error with "`file`: " in front of its text; a file that is already named is not named twice.
  Error in_file(std::string_view file) const;

 private:
  Error(Kind kind, const std::string& text, bool has_file);
  Kind kind_;
  bool has_file_ = false;
};

/// Shorthands: `throw invalid_input("shape smile", "holds NaN", "give finite numbers")`.
Error invalid_input(std::string_view place, std::string_view problem, std::string_view remedy = {});
Error io_error(std::string_view place, std::string_view problem, std::string_view remedy = {});

}  // namespace mien
