#pragma once

#include <string>
#include <utility>

#include <tl/expected.hpp>

namespace lightvane {

/// What is wrong with something the user gave us, in one message: where, what, and how to mend it; or that
/// the work was stopped.
struct Error {
  std::string where;    ///< "file", "file:line:column", "--option"; empty where there is no place to point at
  std::string what;     ///< what was expected and what was found, without a full stop
  std::string hint;     ///< how to mend it; may be empty
  bool isStop = false;  ///< nothing is wrong: the work was told to end (load_watch.h)

  /// "where: what (hint)"
  std::string message() const {
    std::string text = where.empty() ? what : where + ": " + what;
    if (!hint.empty()) text += " (" + hint + ")";
    return text;
  }
};

/// A value, or why there is none. For bad input only: broken invariants throw (check.h), a miss is
/// std::optional.
template <class T>
using Expected = tl::expected<T, Error>;

inline tl::unexpected<Error> makeError(std::string where, std::string what, std::string hint = {}) {
  return tl::unexpected<Error>(Error{std::move(where), std::move(what), std::move(hint)});
}

/// What work ends with that was told to end.
inline Error stopError() { return Error{"", "stopped", "", true}; }

}  // namespace lightvane
