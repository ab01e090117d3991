#!/usr/bin/env python3
import asyncio

import skein

greeting = skein.load("greeter.idl").greeting


async def main():
    with skein.Entity("guests") as guests:
        greeter = await guests.async_connect(greeting.IGreeter)
        print(await asyncio.gather(greeter.greet("Ada"), greeter.greet("Grace")))


asyncio.run(main())
