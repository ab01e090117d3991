#include <algorithm>
#include <cmath>

#include "command/figures.hpp"
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
  if (vendor.version == vendor.tested) {
    symptoms.push_back({Severity::Fine, vendor.name, "loads, version " + vendor.version, "", ""});
    return;
  }
  symptoms.push_back({Severity::Warning, vendor.name,
                      "Skein is tested with version " + vendor.tested + " of " + vendor.name +
                          ", and this is " + (vendor.version.empty() ? "another" : vendor.version),
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
  if (!facts.clock) {
    return {Severity::Note, "clock", "the kernel does not tell whether the clock is right",
            "adjtimex() fails", ""};
  }
  if (std::abs(facts.clock->stepped.count()) >= 1000) {
    return {Severity::Warning, "clock",
            "the clock jumps: times in logs and lifespans of samples are wrong",
            "by " + std::to_string(facts.clock->stepped.count() / 1000) + " ms within a moment",
            "let one program alone set it, by small steps: chronyd, or systemd-timesyncd"};
  }
  if (facts.clock->synchronised) return {Severity::Fine, "clock", "is synchronised", "", ""};
  const bool matters = purpose.several_hosts || !purpose.interfaces.empty();
  return {matters ? Severity::Warning : Severity::Note, "clock",
          matters
              ? "the clock is not synchronised: hosts disagree on when a sample was sent, and drop "
                "it where it has a lifespan"
              : "the clock is not synchronised, which matters between hosts alone",
          "adjtimex() says STA_UNSYNC", "sudo apt-get install chrony"};
}

Symptom leftovers(const SharedMemory& memory) {
  std::uint64_t size = 0;
  std::string names, paths;
  std::size_t count = 0;
  for (const SharedFile& file : memory.files) {
    if (file.in_use) continue;
    size += file.size;
    paths += " " + file.path;
    if (++count <= 4)
      names += (count == 1 ? "" : ", ") + file.path + " (" + std::to_string(file.size) + " bytes)";
  }
  if (count == 0)
    return {Severity::Fine, "shared memory", "no process has left anything behind", "", ""};
  if (count > 4) names += " and " + std::to_string(count - 4) + " more";
  return {Severity::Warning, "shared memory",
          "processes that were killed have left " + std::to_string(count) +
              (count == 1 ? " file" : " files") + " behind, " + short_size(size),
          names, "rm" + paths};
}

void shared_memory(const Purpose& purpose, const Facts& facts, Symptoms& symptoms) {
  if (!facts.shared_memory) {
    symptoms.push_back({purpose.shared_memory ? Severity::Error : Severity::Note, "shared memory",
                        "this system has no shared memory at /dev/shm", "", ""});
    return;
  }
  symptoms.push_back(leftovers(*facts.shared_memory));
  // What a participant with shared memory takes at once.
  constexpr std::uint64_t kSegment = 16 * kMiB;
  if (facts.shared_memory->free >= 4 * kSegment) return;
  symptoms.push_back({purpose.shared_memory ? Severity::Warning : Severity::Note, "shared memory",
                      whole_mebibytes(facts.shared_memory->free) +
                          " are free in /dev/shm, and each peer "
                          "with shared_memory=\"true\" takes " +
                          whole_mebibytes(kSegment),
                      "df /dev/shm",
                      "sudo mount -o remount,size=1G /dev/shm; of a container: "
                      "--shm-size=1g"});
}

void open_files(const Facts& facts, Symptoms& symptoms) {
  constexpr std::uint64_t kEnough = 1024;
  if (!facts.limits.open_files || *facts.limits.open_files >= kEnough) return;
  symptoms.push_back({Severity::Warning, "limits",
                      "a process may open " + std::to_string(*facts.limits.open_files) +
                          " files: with many peers, sockets and pipes cannot be opened",
                      "ulimit -n", "ulimit -n " + std::to_string(kEnough)});
}

void address_space(const Facts& facts, Symptoms& symptoms) {
  if (!facts.limits.address_space) return;
  const bool hopeless = *facts.limits.address_space < 256 * kMiB;
  symptoms.push_back({hopeless ? Severity::Error : Severity::Warning, "limits",
                      "the address space of a process is limited to " +
                          whole_mebibytes(*facts.limits.address_space) +
                          ": stacks of threads count whole",
                      "ulimit -v", "ulimit -v unlimited; limit memory by a control group instead"});
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
  address_space(facts, symptoms);
  real_time(purpose, facts, symptoms);
  if (symptoms.size() == before)
    symptoms.push_back(
        {Severity::Fine, "limits", "files, address space and priorities suffice", "", ""});
}

std::string decimal(double value) {
  const auto tenths = static_cast<long>(std::lround(value * 10));
  return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10);
}

void processors(const Facts& facts, Symptoms& symptoms) {
  const Processors& them = facts.processors;
  const std::string of_all = " of " + std::to_string(them.present) + " processors";
  if (them.quota && *them.quota < them.allowed) {
    symptoms.push_back({*them.quota < 1 ? Severity::Warning : Severity::Note, "processors",
                        "the control group may use " + decimal(*them.quota) + of_all +
                            ": whoever has used its share waits for the next period",
                        "cpu.max or cpu.cfs_quota_us of the group",
                        *them.quota < 1 ? "give it one at least; of a container: --cpus" : ""});
  } else {
    symptoms.push_back({Severity::Fine, "processors",
                        std::to_string(them.allowed) + of_all + " may be used", "", ""});
  }
  if (them.memory && *them.memory < 256 * kMiB) {
    symptoms.push_back({Severity::Warning, "memory",
                        "the control group may use " + whole_mebibytes(*them.memory) +
                            ": the kernel ends processes that need more",
                        "memory.max or memory.limit_in_bytes of the group",
                        "give it 256 MiB at least; of a container: --memory"});
  }
}

void folders(const Facts& facts, Symptoms& symptoms) {
  for (const std::string& folder : facts.missing_folders) {
    symptoms.push_back({Severity::Warning, "plugins",
                        "SKEIN_MODULE_PATH names a folder that is not there", folder,
                        "make it, or take it out of SKEIN_MODULE_PATH"});
  }
}

}  // namespace

Symptoms diagnose_system(const Purpose& purpose, const Facts& facts) {
  Symptoms symptoms;
  vendors(purpose, facts, symptoms);
  symptoms.push_back(clock(purpose, facts));
  shared_memory(purpose, facts, symptoms);
  limits(purpose, facts, symptoms);
  processors(facts, symptoms);
  folders(facts, symptoms);
  return symptoms;
}

}  // namespace skein::command::doctor
