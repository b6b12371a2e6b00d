#include "sim/training/one_thread.hpp"

#include <ATen/Parallel.h>
#include <dlfcn.h>

namespace tumblesight::sim {

void keep_to_one_thread() {
  at::set_num_threads(1);
  if (void* set_threads = dlsym(RTLD_DEFAULT, "openblas_set_num_threads")) {
    reinterpret_cast<void (*)(int)>(set_threads)(1);
  }
}

}  // namespace tumblesight::sim
