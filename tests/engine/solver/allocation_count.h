#pragma once

namespace capstan::test {

/// Calls of operator new in this program so far, in any of its forms.
long allocations();

}  // namespace capstan::test
