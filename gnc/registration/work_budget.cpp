#include "gnc/registration/work_budget.hpp"

namespace tumblesight::gnc {

void WorkBudget::look_at_deadline() {
  since_look_ = 0;
  if (is_late_ || !deadline_->has_passed()) return;
  is_late_ = true;
  left_ = kExhausted;
}

}  // namespace tumblesight::gnc
