#!/usr/bin/env python3
import skein

greeting = skein.load("greeter.idl").greeting


class Formal(greeting.IGreeter):
    def greet(self, name):
        return f"I have the honour to greet you, {name}."


class Brief(greeting.IGreeter):
    def greet(self, name):
        return f"Hi {name}"


with skein.Entity("choosy") as choosy:
    choosy.provide(Formal(), csp="Formal", attributes={"quality": 0.9})
    choosy.provide(Brief(), csp="Brief", attributes={"quality": 0.4})
    outcome = choosy.perform(greeting.IGreeter, "greet", "world", evaluate=lambda text: len(text) < 20 or "too long")
    print(outcome.result, [(each["csp"], each["outcome"]) for each in outcome.decision["attempts"]])
