#include "studies/support/save_request.hpp"

namespace strongpoint {

SaveRequest::Server::Server(SaveRequest* request) : request_(request) {
  if (request_ == nullptr) return;
  const std::lock_guard lock(request_->mutex_);
  request_->has_server_ = true;
}

SaveRequest::Server::~Server() {
  if (request_ == nullptr) return;
  const std::lock_guard lock(request_->mutex_);
  request_->has_server_ = false;
  request_->changed_.notify_all();
}

void SaveRequest::Server::done() {
  const std::lock_guard lock(request_->mutex_);
  request_->asked_ = false;
  request_->changed_.notify_all();
}

void SaveRequest::ask(std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  if (!has_server_) return;
  asked_ = true;
  changed_.wait_for(lock, patience, [this] { return !asked_ || !has_server_; });
}

}  // namespace strongpoint
