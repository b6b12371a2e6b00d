#include "gnc/registration/work_budget.hpp"

namespace tumblesight::gnc {

void WorkBudget::look_at_deadline() {
  is_late_ = deadline_->has_passed();
  look_at_ = is_late_ ? kNever : left_ - kBetweenLooks;
  if (is_late_) left_ = kExhausted;
}

}  // namespace tumblesight::gnc
