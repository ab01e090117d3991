with Skein.C;
with Skein.Errors;

package body Skein.Types is

   function Make (From : Bytes) return Description is
      Sink : Errors.Sink;
   begin
      return Made : Description do
         Errors.Check (C.skein_interface_new (From'Address, From'Length, Made.Handle, Sink.Id), Sink);
      end return;
   end Make;

end Skein.Types;
