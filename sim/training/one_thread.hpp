// Limits LibTorch and the libraries that it uses to one thread.
#pragma once

namespace tumblesight::sim {

// Applies to everything that the calling thread computes from now on. While other threads render, LibTorch's
// own threads mostly wait for each other. OpenBLAS's threads wait by spinning, which costs a quarter of the
// training's time.
void keep_to_one_thread();

}  // namespace tumblesight::sim
