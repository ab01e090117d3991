#include <algorithm>

#include "dds/port/vendor_names.hpp"
#include "diagnosis.hpp"

namespace skein::command::doctor {
namespace {

constexpr std::uint64_t kMiB = 1 << 20;

std::string whole_mebibytes(std::uint64_t bytes) { return std::to_string(bytes / kMiB) + " MiB"; }

bool loads(const VendorModule& vendor) { return vendor.failure.empty(); }

void vendor(const Purpose& purpose, const VendorModule& vendor, bool another_loads,
            Symptoms& symptoms) {
  const bool used = std::ranges::count(purpose.vendors, vendor.name) > 0;
  if (!loads(vendor)) {
    symptoms.push_back({used || !another_loads ? Severity::Error : Severity::Warning, vendor.name,
                        "the DDS vendor " + vendor.name + " cannot be loaded", vendor.failure,
                        used || !another_loads
                            ? "do what the evidence says, or name another vendor in the profile"
                            : "do what the evidence says, if you want this vendor"});
    return;
  }
  if (std::ranges::count(vendor.tested, vendor.version) > 0) {
    symptoms.push_back({Severity::Fine, vendor.name, "loads, version " + vendor.version, "", ""});
    return;
  }
  symptoms.push_back({Severity::Warning, vendor.name,
                      "Skein is tested with version " + dds::alternatives(vendor.tested) + " of " +
                          vendor.name + ", and this is " +
                          (vendor.version.empty() ? "another" : vendor.version),
                      vendor.library, "install that version, or run Skein's tests with this one"});
}

void vendors(const Purpose& purpose, const Facts& facts, Symptoms& symptoms) {
  for (const VendorModule& one : facts.vendors) {
    const bool another = std::ranges::any_of(
        facts.vendors, [&](const VendorModule& other) { return &other != &one && loads(other); });
    vendor(purpose, one, another, symptoms);
  }
}

Symptom clock(const Purpose& purpose, const Facts& facts) {
  if (!facts.synchronised_clock) {
    return {Severity::Note, "clock", "the kernel does not tell whether the clock is right",
            "adjtimex() fails", ""};
  }
  if (*facts.synchronised_clock) return {Severity::Fine, "clock", "is synchronised", "", ""};
  const bool matters = purpose.several_hosts || !purpose.interfaces.empty();
  return {matters ? Severity::Warning : Severity::Note, "clock",
          matters
              ? "the clock is not synchronised: hosts disagree on when a sample was sent, and drop "
                "it where it has a lifespan"
              : "the clock is not synchronised, which matters between hosts alone",
          "adjtimex() says STA_UNSYNC", "sudo apt-get install chrony"};
}

Symptom shared_memory(const Purpose& purpose, const Facts& facts) {
  constexpr const char* kAbout = "shared memory";
  if (!facts.free_shared_memory) {
    return {purpose.shared_memory ? Severity::Error : Severity::Note, kAbout,
            "this system has no shared memory at /dev/shm", "", "sudo mount -t tmpfs shm /dev/shm"};
  }
  // What a participant with shared memory takes at once.
  constexpr std::uint64_t kSegment = 16 * kMiB;
  const std::string free = whole_mebibytes(*facts.free_shared_memory) + " are free in /dev/shm";
  if (*facts.free_shared_memory >= 4 * kSegment) return {Severity::Fine, kAbout, free, "", ""};
  return {purpose.shared_memory ? Severity::Warning : Severity::Note, kAbout,
          free + ", and each peer with shared_memory=\"true\" takes " + whole_mebibytes(kSegment),
          "df /dev/shm",
          "while no mission flies, remove there what killed processes have left; or: sudo mount -o "
          "remount,size=1G /dev/shm; of a container: --shm-size=1g"};
}

void open_files(const Facts& facts, Symptoms& symptoms) {
  constexpr std::uint64_t kEnough = 1024;
  if (!facts.limits.open_files || *facts.limits.open_files >= kEnough) return;
  symptoms.push_back({Severity::Warning, "limits",
                      "a process may open " + std::to_string(*facts.limits.open_files) +
                          " files: with many peers, sockets and pipes cannot be opened",
                      "ulimit -n", "ulimit -n " + std::to_string(kEnough)});
}

void real_time(const Purpose& purpose, const Facts& facts, Symptoms& symptoms) {
  if (purpose.priority > facts.limits.real_time_priority) {
    symptoms.push_back({Severity::Warning, "limits",
                        "the mission asks for real-time priority " +
                            std::to_string(purpose.priority) + ", and this user may have " +
                            std::to_string(facts.limits.real_time_priority),
                        "ulimit -r",
                        "in /etc/security/limits.d/skein.conf: USER - rtprio " +
                            std::to_string(purpose.priority) + "; then log in again"});
  }
  if (purpose.locks_memory && facts.limits.locked_memory) {
    symptoms.push_back({Severity::Warning, "limits",
                        "the mission locks its memory, and this user may lock " +
                            whole_mebibytes(*facts.limits.locked_memory),
                        "ulimit -l",
                        "in /etc/security/limits.d/skein.conf: USER - memlock unlimited; then "
                        "log in again"});
  }
}

void limits(const Purpose& purpose, const Facts& facts, Symptoms& symptoms) {
  const std::size_t before = symptoms.size();
  open_files(facts, symptoms);
  real_time(purpose, facts, symptoms);
  if (symptoms.size() == before)
    symptoms.push_back({Severity::Fine, "limits", "files and priorities suffice", "", ""});
}

}  // namespace

Symptoms diagnose_system(const Purpose& purpose, const Facts& facts) {
  Symptoms symptoms;
  vendors(purpose, facts, symptoms);
  symptoms.push_back(clock(purpose, facts));
  symptoms.push_back(shared_memory(purpose, facts));
  limits(purpose, facts, symptoms);
  return symptoms;
}

}  // namespace skein::command::doctor
