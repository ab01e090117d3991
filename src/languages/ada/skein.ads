with Ada.Containers.Indefinite_Holders;
with Ada.Streams;
with Ada.Strings.Unbounded;
with Interfaces;

--  Skein for Ada. Texts are UTF-8: of others make them by Ada.Strings.UTF_Encoding. Everything may be used by several tasks at once.
--  What services and subscribers do runs on threads of C++, which a stack overflow ends with their process.
package Skein is

   --  What a caller can do next. Errors.Text gives the whole reason, of which an exception's message has 200 characters at most.
   Unavailable      : exception;  --  Not executed: no provider is available. Try later or elsewhere.
   Overloaded       : exception;  --  Not executed: a queue is full. Back off, then try again.
   Disconnected     : exception;  --  The provider died or left; whether the call ran is unknown.
   Timed_Out        : exception;  --  The deadline passed; whether the call ran is unknown.
   Cancelled        : exception;  --  The caller gave up; whether the call ran is unknown.
   Unimplemented    : exception;  --  The provider does not know the operation or this version of it.
   Invalid_Argument : exception;  --  The input is invalid; the same input will fail again.
   Internal         : exception;  --  A failure that the interface does not declare.

   function "+" (Text : String) return Ada.Strings.Unbounded.Unbounded_String
     renames Ada.Strings.Unbounded.To_Unbounded_String;

   --  A value within a value of its own type: generated functions To_Box and From_Box convert. An empty one is an initial value.
   type Boxed is abstract tagged null record;
   package Boxes is new Ada.Containers.Indefinite_Holders (Boxed'Class);
   subtype Box is Boxes.Holder;

   --  A service as a value; none, if the provider is all 0.
   type Identity is array (1 .. 16) of Interfaces.Unsigned_8;
   type Reference is record
      Interface_Name : Ada.Strings.Unbounded.Unbounded_String;
      Provider       : Identity := (others => 0);
      Instance       : Ada.Strings.Unbounded.Unbounded_String;
   end record;

   type Log_Level is (Debug, Info, Warning, Error);
   --  Logs a line; Place is a part of the program. `skein log` shows it.
   procedure Log (Level : Log_Level; Place, Text : String);

   --  Waits until the process is told to end: SIGTERM, SIGINT (Ctrl-C) or SIGHUP. Only one task may wait.
   procedure Wait_For_Signal;

   subtype Bytes is Ada.Streams.Stream_Element_Array;

end Skein;
