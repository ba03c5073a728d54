#pragma once
/// What a call that must fail says.

#include <gtest/gtest.h>

#include <string>

#include "mien/core/error.h"

namespace mien::test {

/// The message of the error that `call` reports, which must be of this kind; "no error" when it reports none.
template <class Call>
std::string error_of(const Call& call, Error::Kind kind = Error::Kind::invalid_input) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_TRUE(error.kind() == kind) << error.what();
    return error.what();
  }
  return "no error";
}

}  // namespace mien::test
