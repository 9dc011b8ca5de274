// All contracts, for code that treats every kind alike.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "stillpoint/sdk.hpp"

namespace stillpoint {

/// The kind that a contract is for, and the API number of the contract.
struct KindApi {
  std::string_view kind;
  std::uint32_t api;
};

template <class... Interfaces>
struct ContractList {
  static constexpr std::array<KindApi, sizeof...(Interfaces)> kKinds = {
      KindApi{Interfaces::kKind, Interfaces::kApi}...};

  /// Calls function.template operator()<Interface>() for each.
  template <class Function>
  static void for_each(const Function& function) {
    (function.template operator()<Interfaces>(), ...);
  }
};

/// In the order of the paper's Fig. 2.
using Contracts = ContractList<Source, Segmenter, Propagator, MovingChecker, MapChecker, Decision,
                               Tracker, LocalMapper, LoopCloser, MapBackend, Output>;

}  // namespace stillpoint
