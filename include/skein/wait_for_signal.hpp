#pragma once

#include "skein/detail/version.hpp"

namespace skein {

/// Waits until this process is told to end, and returns the signal by which it was: SIGTERM, SIGINT
/// (Ctrl-C) or SIGHUP. What a program does whose entities work by themselves:
///
///     entity.provide<greeting::IGreeter>(std::make_shared<Greeter>());
///     skein::wait_for_signal();
///
/// It may be called however many threads there are already, and it does not matter whether some of
/// them, or all, block these signals. A signal that the process ignores when the call begins stays
/// ignored: nohup has it ignore SIGHUP, a script has what it starts by `&` ignore SIGINT.
///
/// While the call lasts it takes the place of the process's own handlers of these signals; before
/// and after it they act as usual, so that a second Ctrl-C ends a program whose end takes long.
/// Peers that `skein launch` starts do not need it: their code is told to end (see await_end()).
///
/// One thread at a time: throws InvalidArgument while another one waits.
int wait_for_signal();

}  // namespace skein
