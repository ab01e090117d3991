with Ada.Finalization;
with Ada.Strings.Unbounded;
with Interfaces;
with Skein.CDR;
with Skein.Entities;
with Skein.Types;

--  What generated proxies stand on.
package Skein.Proxies is

   --  Which provider to connect to. Name is of an interface or an entity, by default the interface; System by default the entity's own,
   --  "*" any; Strategy is for the provider's Head; Timeout, to find a provider, is 5 s by default. A Choice of the name of an entity
   --  itself finds a CSP of its own.
   type Choice is record
      Name     : Ada.Strings.Unbounded.Unbounded_String;
      System   : Ada.Strings.Unbounded.Unbounded_String;
      Strategy : Ada.Strings.Unbounded.Unbounded_String;
      Timeout  : Duration := 0.0;
   end record;
   Any : constant Choice := (others => <>);

   --  A connection: each call goes to the current provider, or to another one if that is lost. It ends with the object's scope.
   type Proxy is tagged limited private;

   --  A call that was begun: its operation's Finish_ function waits for its end, once. To end its scope cancels it, and so does to begin
   --  another call with it. Neither an `abort`
   --  nor a `select ... then abort` ends a wait: give Within, or let another task call Cancel.
   type Pending is tagged limited private;
   --  The call ends as Cancelled, unless it has ended.
   procedure Cancel (Call : in out Pending);

   --  Results of an operation under @stream, by its Next. To end its scope cancels the operation.
   type Result_Stream is tagged limited private;

   --  What follows is for generated code. Calls end after 5 s if Within is 0.

   procedure Connect (Self : in out Proxy'Class; Own : Entities.Entity'Class; To : Types.Description; By : Choice);
   procedure Call (Self : Proxy'Class; Operation : String; Arguments : CDR.Writer; Within : Duration);
   function Call (Self : Proxy'Class; Operation : String; Arguments : CDR.Writer; Within : Duration) return CDR.Reader;
   procedure Start
     (Self : Proxy'Class; Operation : String; Arguments : CDR.Writer; Within : Duration; Begun : in out Pending'Class);
   function Finish (Call : in out Pending'Class; Operation : String) return CDR.Reader;
   procedure Start
     (Self : Proxy'Class; Operation : String; Arguments : CDR.Writer; Within : Duration; Begun : in out Result_Stream'Class);
   --  Without a message at the end of the stream.
   function Take (From : in out Result_Stream'Class) return CDR.Reader;

private

   type Proxy is new Ada.Finalization.Limited_Controlled with record
      Handle : Interfaces.Unsigned_64 := 0;
   end record;
   overriding procedure Finalize (Self : in out Proxy);

   type Pending is new Ada.Finalization.Limited_Controlled with record
      Handle    : Interfaces.Unsigned_64 := 0;
      Operation : Ada.Strings.Unbounded.Unbounded_String;
   end record;
   overriding procedure Finalize (Self : in out Pending);

   type Result_Stream is new Ada.Finalization.Limited_Controlled with record
      Handle : Interfaces.Unsigned_64 := 0;
   end record;
   overriding procedure Finalize (Self : in out Result_Stream);

end Skein.Proxies;
