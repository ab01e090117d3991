with Interfaces.C.Extensions;
with Interfaces.C.Strings;
with Skein.C;
with Skein.Errors;

package body Skein.Entities is

   use Ada.Strings.Unbounded;
   use Interfaces.C.Strings;

   --  Texts for C, which Free gives back.
   function New_Texts (From : Texts) return chars_ptr_array is
   begin
      return Made : chars_ptr_array (1 .. From'Length) do
         for I in From'Range loop
            Made (Interfaces.C.size_t (I - From'First + 1)) := New_String (To_String (From (I)));
         end loop;
      end return;
   end New_Texts;

   procedure Free_All (Items : in out chars_ptr_array) is
   begin
      for Each of Items loop
         Free (Each);
      end loop;
   end Free_All;

   function Join
     (Name                : String;
      Vendor              : String := "cyclonedds";
      System              : String := "";
      Domain              : Natural := 0;
      Network             : Texts := No_Texts;
      Peers               : Texts := No_Texts;
      Multicast           : Boolean := False;
      Shared_Memory_Calls : Boolean := True;
      Lease               : Duration := 0.0) return Entity
   is
      Names   : chars_ptr_array := New_Texts (Texts'(+Name, +System, +Vendor));
      Devices : chars_ptr_array := New_Texts (Network);
      Hosts   : chars_ptr_array := New_Texts (Peers);
      Options : constant C.Entity_Options :=
        (Name => Names (1), System_Name => (if System = "" then Null_Ptr else Names (2)), Vendor => Names (3),
         Network => Devices'Address, Network_Size => Devices'Length, Peers => Hosts'Address, Peers_Size => Hosts'Length,
         Domain => Interfaces.Unsigned_32 (Domain), Multicast => Interfaces.C.Extensions.bool (Multicast),
         No_Shared_Memory_Calls => Interfaces.C.Extensions.bool (not Shared_Memory_Calls), Lease => C.Nanoseconds (Lease), others => <>);
      Sink : Errors.Sink;
      Done : Interfaces.C.Extensions.bool;
   begin
      return Made : Entity do
         Done := C.skein_entity_new (Options, Made.Handle, Sink.Id);
         Free_All (Names);
         Free_All (Devices);
         Free_All (Hosts);
         Errors.Check (Done, Sink);
      end return;
   end Join;

   overriding procedure Finalize (Self : in out Entity) is
      Sink : Errors.Sink;
   begin
      if not Boolean (C.skein_entity_free (Self.Handle, Sink.Id)) then
         Log (Error, "ada", "an entity stays: " & Value (C.skein_error_text (Sink.Id)));
      end if;
      Self.Handle := C.None;
   end Finalize;

   function Id (Self : Entity) return String is
      Sink : Errors.Sink;
      Text : chars_ptr;
   begin
      Errors.Check (C.skein_entity_id (Self.Handle, Text, Sink.Id), Sink);
      return Value (Text);
   end Id;

   function Drain (Self : Entity; Patience : Duration) return Boolean is
      Sink    : Errors.Sink;
      Drained : Interfaces.C.Extensions.bool;
   begin
      Errors.Check (C.skein_entity_drain (Self.Handle, C.Nanoseconds (Patience), Drained, Sink.Id), Sink);
      return Boolean (Drained);
   end Drain;

end Skein.Entities;
