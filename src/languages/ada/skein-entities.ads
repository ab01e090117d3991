with Ada.Finalization;
with Ada.Strings.Unbounded;
with Interfaces;

package Skein.Entities is

   type Texts is array (Positive range <>) of Ada.Strings.Unbounded.Unbounded_String;
   No_Texts : constant Texts (1 .. 0) := (others => <>);

   --  An autonomous entity: provides services, connects to those of others, publishes and subscribes. It leaves the mission when the
   --  object's scope ends, which waits at most 2 s for calls that run; calls that wait for others raise Disconnected. Declare its
   --  providers and subscriptions behind it. A callback of its own cannot end it: then it stays.
   type Entity is tagged limited private;

   --  Joins the mission. The system is by default "default"; the network interfaces or addresses are 127.0.0.1; Peers are hosts on which
   --  to look for participants; a peer that is silent for the lease, by default 1 s, is lost. The vendor may be "fastdds", too, or,
   --  within the process, "loopback".
   function Join
     (Name                : String;
      Vendor              : String := "cyclonedds";
      System              : String := "";
      Domain              : Natural := 0;
      Network             : Texts := No_Texts;
      Peers               : Texts := No_Texts;
      Multicast           : Boolean := False;
      Shared_Memory_Calls : Boolean := True;
      Lease               : Duration := 0.0) return Entity;

   --  System/name.
   function Id (Self : Entity) return String;
   --  Withdraws all services without loss: tells clients to go elsewhere, and serves what they had sent. False if that took longer.
   function Drain (Self : Entity; Patience : Duration) return Boolean;

   --  For generated code.
   function Handle (Self : Entity) return Interfaces.Unsigned_64;

private

   type Entity is new Ada.Finalization.Limited_Controlled with record
      Handle : Interfaces.Unsigned_64 := 0;
   end record;
   overriding procedure Finalize (Self : in out Entity);
   function Handle (Self : Entity) return Interfaces.Unsigned_64 is (Self.Handle);

end Skein.Entities;
