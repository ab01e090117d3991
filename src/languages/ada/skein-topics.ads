with Skein.CDR;
with Skein.Entities;
with Skein.Types;
private with Ada.Finalization;
private with Interfaces;

--  Topics of one type. With a use clause for the package that declares Depth: package Depths is new Skein.Topics (Depth,
--  Depth_Topic_Type).
generic
   type Value is private;
   Of_Type : Types.Topic_Type;
   with procedure Put (Into : in out CDR.Writer; Item : Value) is <>;
   with procedure Get (From : in out CDR.Reader; Item : out Value) is <>;
package Skein.Topics is

   --  What fits the data; use the same on both sides. Period is the lifespan of a sensor's values, by default 0.5 s, and how often a
   --  command comes, by default 0.1 s.
   type Profile is
     (Every_Value,  --  Reliable, in order.
      Sensor,       --  Best effort; only new values matter.
      Command,      --  The newest value of the strongest publisher.
      State);       --  The last value of each key, also for late joiners.

   --  Publishes until the object's scope or its entity ends.
   type Publisher is tagged limited private;
   function Publish_On
     (Own : Entities.Entity'Class; Topic : String; By : Profile := Every_Value; Period : Duration := 0.0) return Publisher;
   --  Raises Overloaded if reliable subscribers make no room in time.
   procedure Publish (Self : Publisher; Item : Value);
   --  How many are matched now.
   function Subscribers (Self : Publisher) return Natural;

   --  What gets the values, on the entity's thread for topics.
   type Listener is limited interface;
   procedure Receive (Self : in out Listener; Item : Value) is abstract;

   --  Subscribes until the object's scope or its entity ends; To must live as long. The scope's end waits for a call of Receive, so do
   --  not let one end it.
   type Subscription is tagged limited private;
   function Subscribe
     (Own : Entities.Entity'Class; Topic : String; To : not null access Listener'Class; By : Profile := Every_Value;
      Period : Duration := 0.0) return Subscription;
   --  How many are matched now.
   function Publishers (Self : Subscription) return Natural;

private

   type Publisher is new Ada.Finalization.Limited_Controlled with record
      Handle : Interfaces.Unsigned_64 := 0;
   end record;
   overriding procedure Finalize (Self : in out Publisher);

   type Registration;
   type Registration_Access is access Registration;
   pragma No_Strict_Aliasing (Registration_Access);
   type Subscription is new Ada.Finalization.Limited_Controlled with record
      Handle     : Interfaces.Unsigned_64 := 0;
      Registered : Registration_Access;
   end record;
   overriding procedure Finalize (Self : in out Subscription);

end Skein.Topics;
