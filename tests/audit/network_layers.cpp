// Prints the network's layers in the order of execution, one a line: part of the network, name,
// multiply-accumulates per frame, and type as the symbols of a program name it. For network_layers.py.
#include <cxxabi.h>

#include <cstdio>
#include <cstdlib>
#include <typeinfo>
#include <utility>

#include "gnc/rcnn/network_shape.hpp"

namespace gnc = tumblesight::gnc;

template <class N, int kIndex>
void print_layer() {
  constexpr gnc::LayerRow kRow = gnc::kLayers[kIndex];
  using Type = typename gnc::LayerOfKind<kRow.kind>::template Type<N, kRow.side, kRow.inputs, kRow.outputs>;
  const char* const part = kIndex < gnc::kLstmLayer ? "cnn" : kIndex == gnc::kLstmLayer ? "lstm" : "head";
  int status = 0;
  char* const type = abi::__cxa_demangle(typeid(Type).name(), nullptr, nullptr, &status);
  std::printf("%s %s %ld %s\n", part, kRow.name, static_cast<long>(Type::kMacs), type);
  std::free(type);
}

template <int... kIndex>
void print_layers(std::integer_sequence<int, kIndex...>) {
  (print_layer<gnc::FixedPoint, kIndex>(), ...);
}

int main() {
  print_layers(std::make_integer_sequence<int, gnc::kLayerCount>());
}
