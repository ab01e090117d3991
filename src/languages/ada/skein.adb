with Ada.Strings.Fixed;
with Interfaces.C;
with Skein.C;
with Skein.Errors;

package body Skein is

   --  GNAT's own handler of SIGINT would end the process before Wait_For_Signal sees it.
   pragma Unreserve_All_Interrupts;

   procedure Log (Level : Log_Level; Place, Text : String) is
      Sink : Errors.Sink;
   begin
      if Ada.Strings.Fixed.Index (Place & Text, (1 => ASCII.NUL)) > 0 then
         raise Invalid_Argument with "a line of the log cannot have a character of 0";
      end if;
      Errors.Check (C.skein_log_write (Log_Level'Pos (Level), Interfaces.C.To_C (Place), Interfaces.C.To_C (Text), Sink.Id), Sink);
   end Log;

   procedure Wait_For_Signal is
      Sink   : Errors.Sink;
      Signal : Interfaces.Integer_32 with Warnings => Off;
   begin
      Errors.Check (C.skein_signal_wait (Signal, Sink.Id), Sink);
   end Wait_For_Signal;

end Skein;
