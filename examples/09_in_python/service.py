#!/usr/bin/env python3
import skein

greeting = skein.load("greeter.idl").greeting


class Greeter(greeting.IGreeter):
    def greet(self, name):
        return f"Hello, {name}!"


with skein.Entity("host") as host:
    host.provide(Greeter())
    skein.ready()
    skein.wait()
