#include "live_camera/driver_library.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/error_text.hpp"

namespace stillpoint::live_camera {
namespace {

using stillpoint::testing::error_text;
using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(DriverLibrary, SaysWhichPackageIsMissing) {
  EXPECT_THAT(error_text(Fault::kUsage, [] { DriverLibrary("libnone.so.7", "libnone7"); }),
              AllOf(HasSubstr("libnone.so.7: cannot open shared object file"),
                    HasSubstr("install it, on Debian the package libnone7")));
}

TEST(DriverLibrary, FindsItsFunctions) {
  const DriverLibrary mathematics("libm.so.6", "libc6");
  EXPECT_EQ(mathematics.function<double(double)>("fabs")(-3.0), 3.0);
}

TEST(DriverLibrary, SaysWhichFunctionIsMissing) {
  const DriverLibrary mathematics("libm.so.6", "libc6");
  EXPECT_THAT(error_text(Fault::kUsage, [&] { mathematics.function<void()>("freenect_init"); }),
              AllOf(HasSubstr("libm.so.6: it has no function freenect_init"),
                    HasSubstr("another version")));
}

}  // namespace
}  // namespace stillpoint::live_camera
