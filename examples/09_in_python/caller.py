#!/usr/bin/env python3
import skein

greeting = skein.load("greeter.idl").greeting

with skein.Entity("guest", vendor="fastdds") as guest:
    print(guest.connect(greeting.IGreeter).greet("world"))
