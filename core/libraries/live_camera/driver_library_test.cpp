#include "live_camera/driver_library.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "stillpoint/error.hpp"

namespace stillpoint::live_camera {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kUsage);
    return error.what();
  }
  return "nothing was thrown";
}

TEST(DriverLibrary, SaysWhichPackageIsMissing) {
  EXPECT_THAT(message_of([] { DriverLibrary("libnone.so.7", "libnone7"); }),
              AllOf(HasSubstr("libnone.so.7: cannot open shared object file"),
                    HasSubstr("install the camera's driver, on Debian the package libnone7")));
}

TEST(DriverLibrary, FindsItsFunctions) {
  const DriverLibrary mathematics("libm.so.6", "libc6");
  EXPECT_EQ(mathematics.function<double(double)>("fabs")(-3.0), 3.0);
}

TEST(DriverLibrary, SaysWhichFunctionIsMissing) {
  const DriverLibrary mathematics("libm.so.6", "libc6");
  EXPECT_THAT(message_of([&] { mathematics.function<void()>("freenect_init"); }),
              AllOf(HasSubstr("libm.so.6: the camera's driver has no function freenect_init"),
                    HasSubstr("another version")));
}

}  // namespace
}  // namespace stillpoint::live_camera
