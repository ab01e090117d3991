#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "command/commands.hpp"
#include "layout.hpp"
#include "requests.hpp"
#include "skein/entity.hpp"
#include "watch.hpp"

namespace skein::command::designer {

/// A domain as a page shows it, with the actions that the page offers. look() and rest() are one
/// thread's; others may call the rest meanwhile.
class LiveDomain {
 public:
  /// Joins the domain. Throws as join().
  LiveDomain(const DesignerArguments& arguments, std::optional<Plan> plan,
             std::function<bool()> gives_up);
  ~LiveDomain();

  /// The domain now, as JSON.
  std::shared_ptr<const std::string> look();
  /// Asks nobody any more until the next look.
  void rest() { watch_.reset(); }
  bool rests() const { return !watch_; }

  Actions actions();
  /// Places for boxes that will appear.
  void place(std::map<std::string, Place> places);

 private:
  class Shown;

  const bool faults_;
  const std::uint32_t domain_;
  const std::optional<Plan> plan_;
  const std::function<bool()> gives_up_;
  const std::unique_ptr<Shown> shown_;
  Entity entity_;
  std::optional<DomainWatch> watch_;  // none while nobody looks
};

}  // namespace skein::command::designer
