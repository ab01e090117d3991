with Ada.Containers.Indefinite_Ordered_Maps;
with Ada.Finalization;
with Ada.Strings.Unbounded;
with Interfaces;
with Skein.CDR;
with Skein.Entities;
with Skein.Types;

--  What generated services stand on.
package Skein.Services is

   package Attribute_Maps is new Ada.Containers.Indefinite_Ordered_Maps (String, String);

   type Options is record
      Attributes : Attribute_Maps.Map;                      --  "latency" in ms or with a unit, "quality", ...
      CSP        : Ada.Strings.Unbounded.Unbounded_String;  --  The name of a CSP, which Owner alone may use.
      Owner      : Ada.Strings.Unbounded.Unbounded_String;  --  The id of an entity; needed for a CSP.
      Threads    : Natural := 0;                            --  How many call the service at once; 0: 1.
      Queue      : Natural := 0;                            --  Calls that may wait; 0: 2048.
   end record;
   Plain : constant Options := (others => <>);

   --  A service that is provided until this object's scope or its entity ends. The scope's end waits for calls that run, so do not let
   --  a call of the service end it: then the service goes on until its entity ends, and refuses all calls.
   type Provider is tagged limited private;

   --  Of the call that this task answers: whether nobody waits for the answer any more.
   function Is_Cancelled return Boolean;
   --  Of the call that this task answers: until the caller's deadline, less than 0 if it has passed.
   function Time_Left return Duration;

   --  What follows is for generated code.

   subtype Reply is Interfaces.Unsigned_64;
   type Handler is abstract tagged limited null record;
   procedure Handle (Self : in out Handler; Operation : String; From : in out CDR.Reader; To : Reply) is abstract;
   type Handler_Access is access Handler'Class;

   procedure Answer (To : Reply; Result : CDR.Writer);
   procedure Push (To : Reply; Item : CDR.Writer);
   procedure Refuse (Operation : String) with No_Return;

   --  Frees the handler when nothing calls it any more.
   function Provide (Own : Entities.Entity'Class; Of_Type : Types.Description; By : Handler_Access; Given : Options) return Provider;

private

   type Registration;
   type Registration_Access is access Registration;
   pragma No_Strict_Aliasing (Registration_Access);
   type Provider is new Ada.Finalization.Limited_Controlled with record
      Handle     : Interfaces.Unsigned_64 := 0;
      Registered : Registration_Access;
   end record;
   overriding procedure Finalize (Self : in out Provider);

end Skein.Services;
