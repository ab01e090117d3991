// omniORB by its C++ mapping, from the same IDL as Skein. `names` is a client of its name server.
// omniORB 4.2 has no asynchronous calls: calls in flight have a thread each.

#include <cstdio>
#include <fstream>
#include <random>
#include <thread>

#include "echo.hh"
#include "omniORB4/Naming.hh"
#include "rivals/main.hpp"

namespace skein::benchmarks::rivals {
namespace {

namespace corba = ::benchmark;

class EchoServant final : public POA_benchmark::Echo {
 public:
  corba::Octets* echo(const corba::Octets& content) override { return new corba::Octets(content); }
  void hold() override { throw CORBA::NO_IMPLEMENT(); }
  CORBA::Boolean holding() override { return false; }
};

CORBA::ORB_ptr make_orb(const std::string& end_point) {
  const char* options[][2] = {{"giopMaxMsgSize", "67108864"},
                              {"maxGIOPConnectionPerServer", "64"},
                              {"clientTransportRule", "* unix,tcp"},
                              {"endPoint", end_point.c_str()},
                              {nullptr, nullptr}};
  int argc = 0;
  return CORBA::ORB_init(argc, nullptr, "omniORB4", options);
}

std::string end_point_of(const Arguments& arguments) {
  return arguments.transport == "unix" ? "giop:unix:" + arguments.path()
                                       : "giop:tcp:127.0.0.1:" + std::to_string(arguments.port());
}

std::string reference_file(const Arguments& arguments) { return arguments.path() + ".ior"; }

/// A POA whose calls from within the process take omniORB's shortcut past the ORB, where wanted.
PortableServer::POA_ptr make_poa(CORBA::ORB_ptr orb, bool shortcut) {
  const CORBA::Object_var object = orb->resolve_initial_references("RootPOA");
  const auto root = PortableServer::POA::_narrow(object);
  const PortableServer::POAManager_var manager = root->the_POAManager();
  manager->activate();
  if (!shortcut) return root;
  CORBA::PolicyList policies(1);
  policies.length(1);
  CORBA::Any wanted;
  wanted <<= omniPolicy::LOCAL_CALLS_SHORTCUT;
  policies[0] = orb->create_policy(omniPolicy::LOCAL_SHORTCUT_POLICY_TYPE, wanted);
  return root->create_POA("shortcut", manager, policies);
}

corba::Echo_ptr activate(PortableServer::POA_ptr poa, PortableServer::ServantBase* servant) {
  const PortableServer::ObjectId_var id = poa->activate_object(servant);
  const CORBA::Object_var object = poa->id_to_reference(id);
  return corba::Echo::_narrow(object);
}

EchoCall call_of(const corba::Echo_var& echo) {
  return [echo](const Content& content, const Seen& seen) {
    const auto size = static_cast<CORBA::ULong>(content.size());
    auto* octets = const_cast<CORBA::Octet*>(content.data());
    const corba::Octets_var reply = echo.in()->echo(corba::Octets(size, size, octets, false));
    seen({reply.in().get_buffer(), reply.in().length()});
  };
}

void server(const Arguments& arguments) {
  const CORBA::ORB_var orb = make_orb(end_point_of(arguments));
  const PortableServer::POA_var poa = make_poa(orb, false);
  const corba::Echo_var echo = activate(poa, new EchoServant);
  const CORBA::String_var reference = orb->object_to_string(echo);
  std::ofstream(reference_file(arguments)) << reference.in();
  run_server();
  std::remove(reference_file(arguments).c_str());
  orb->destroy();
}

// A Unix socket refuses connections while many others wait to be accepted.
CORBA::Boolean once_more(void*, CORBA::ULong attempts, const CORBA::TRANSIENT&) {
  std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return attempts < 2000;
}

void client(const Arguments& arguments) {
  omniORB::installTransientExceptionHandler(nullptr, once_more);
  const CORBA::ORB_var orb = make_orb("giop:tcp:127.0.0.1:");
  std::string reference;
  std::ifstream(reference_file(arguments)) >> reference;
  const CORBA::Object_var object = orb->string_to_object(reference.c_str());
  const EchoCall call = call_of(corba::Echo::_narrow(object));
  call({}, [](auto) {});
  // omniORB opens a connection for each thread that calls at the same time.
  run_client({call, [&] { return call; }});
}

void collocated(const Arguments& arguments) {
  const CORBA::ORB_var orb = make_orb("giop:tcp:127.0.0.1:");
  const PortableServer::POA_var poa = make_poa(orb, arguments.transport == "shortcut");
  const EchoCall call = call_of(activate(poa, new EchoServant));
  run_client({call, [&] { return call; }});
}

CosNaming::Name name_of(std::size_t number) {
  CosNaming::Name name(1);
  name.length(1);
  name[0].id = CORBA::string_dup(("entity" + std::to_string(number)).c_str());
  name[0].kind = CORBA::string_dup("");
  return name;
}

/// The name server's process has only just begun.
CosNaming::NamingContext_ptr when_up(CORBA::Object_ptr object) {
  for (int attempt = 0;; ++attempt) {
    try {
      return CosNaming::NamingContext::_narrow(object);
    } catch (const CORBA::TRANSIENT&) {
      if (attempt == 500) throw;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

void names(const Arguments& arguments) {
  const CORBA::ORB_var orb = make_orb("giop:tcp:127.0.0.1:");
  const PortableServer::POA_var poa = make_poa(orb, false);
  const corba::Echo_var echo = activate(poa, new EchoServant);
  const CORBA::Object_var object = orb->string_to_object(
      ("corbaloc::127.0.0.1:" + std::to_string(arguments.port()) + "/NameService").c_str());
  const CosNaming::NamingContext_var context = when_up(object);
  std::size_t bound = 0;
  const auto bind = [&](const std::string& count) {
    for (; bound < std::stoul(count); ++bound) context->rebind(name_of(bound), echo);
    return std::string("bound");
  };
  const auto find = [&](const std::string& count) {
    std::mt19937 random(1);
    std::string times = "times";
    for (std::size_t i = 0; i < std::stoul(count); ++i) {
      const CosNaming::Name name = name_of(random() % bound);
      const auto begin = std::chrono::steady_clock::now();
      const CORBA::Object_var found = context->resolve(name);
      const auto took = std::chrono::steady_clock::now() - begin;
      times += ' ' + std::to_string(std::chrono::nanoseconds(took).count());
    }
    return times;
  };
  run_commands({{"bind", bind}, {"find", find}});
}

void run(const Arguments& arguments) {
  try {
    if (arguments.role == "server") return server(arguments);
    if (arguments.role == "names") return names(arguments);
    arguments.role == "collocated" ? collocated(arguments) : client(arguments);
  } catch (const CORBA::Exception& error) {
    throw Internal(std::string("omniORB throws ") + error._name());
  }
}

}  // namespace
}  // namespace skein::benchmarks::rivals

int main(int argc, char** argv) {
  return skein::benchmarks::rivals::rival_main(argc, argv, skein::benchmarks::rivals::run);
}
