with Ada.Exceptions;
with Ada.Task_Attributes;
with Ada.Unchecked_Conversion;
with Ada.Unchecked_Deallocation;
with Interfaces.C.Extensions;
with Interfaces.C.Strings;
with Skein.C;
with Skein.Errors;
with Skein.Gates;
with System;

package body Skein.Services is

   use Ada.Exceptions;
   use Ada.Strings.Unbounded;
   use Interfaces.C;
   use Interfaces.C.Strings;

   --  What C holds. The provider frees it once C makes no calls any more; if it could not wait for that, the last callback does.
   type Registration is limited record
      Handler : Handler_Access;
      Gate    : Gates.Gate;
   end record;
   function To_Address is new Ada.Unchecked_Conversion (Registration_Access, System.Address);
   function To_Registration is new Ada.Unchecked_Conversion (System.Address, Registration_Access);
   procedure Free is new Ada.Unchecked_Deallocation (Registration, Registration_Access);
   procedure Free is new Ada.Unchecked_Deallocation (Handler'Class, Handler_Access);

   procedure Free_All (Item : in out Registration_Access) is
   begin
      Free (Item.Handler);
      Free (Item);
   end Free_All;

   procedure Leave (Item : in out Registration_Access) is
      Is_Last : Boolean;
   begin
      Item.Gate.Leave (Is_Last);
      if Is_Last then
         Free_All (Item);
      end if;
      Item := null;
   end Leave;

   package Current is new Ada.Task_Attributes (Reply, 0);

   procedure Ignore (Done : Extensions.bool) is null;

   function Value_Of (Message : CDR.Writer) return C.Value is ((Message.Address, size_t (Message.Size), others => <>));

   --  Tells the caller why there is no answer.
   procedure Fail (To : Reply; Error : Exception_Occurrence) is
      Id : constant Exception_Id := Exception_Identity (Error);

      procedure Tell (Text : String) is
      begin
         Ignore (C.skein_reply_fail (To, Errors.Class_Of (Id), To_C (Text), C.None));
      end Tell;

      procedure Raise_There (Name : String) is
         Sink    : Errors.Sink;
         Members : Bytes renames Errors.Members (Error);
      begin
         Errors.Check (C.skein_reply_raise (To, To_C (Name), (Members'Address, Members'Length, others => <>), Sink.Id), Sink);
      end Raise_There;
   begin
      if Errors.Name_Of (Id) /= "" then
         Raise_There (Errors.Name_Of (Id));
      elsif Errors.Is_Skein (Id) then
         Tell (Errors.Text (Error));
      else
         Tell (Exception_Name (Error) & ": " & Exception_Message (Error));
         Log (Skein.Error, "ada", "a service has raised " & Exception_Information (Error));
      end if;
   exception
      when Other : others =>  --  an exception without members, or one that the operation does not declare
         Tell (Errors.Text (Other));
   end Fail;

   --  Nothing that they raise may pass: C calls them.
   procedure On_Call (User : System.Address; Operation : chars_ptr; Arguments : access constant C.Value; To : Reply)
     with Convention => C;
   procedure On_Close (User : System.Address) with Convention => C;

   procedure Serve (Registered : Registration_Access; Operation : String; Arguments : C.Value; To : Reply) is
      From : CDR.Reader := CDR.Read (Arguments.Data, CDR.Offset (Arguments.Size));
   begin
      if Registered.Gate.Is_Detached then
         raise Unavailable with Gates.Gone;
      end if;
      Registered.Handler.Handle (Operation, From, To);
   end Serve;

   procedure On_Call (User : System.Address; Operation : chars_ptr; Arguments : access constant C.Value; To : Reply) is
   begin
      declare
         Outer : constant Reply := Current.Value;
      begin
         Current.Set_Value (To);
         begin
            Serve (To_Registration (User), Value (Operation), Arguments.all, To);
         exception
            when Error : others =>
               Fail (To, Error);
         end;
         Current.Set_Value (Outer);
      end;
   exception
      when others =>
         null;  --  not even the reason could be told
   end On_Call;

   procedure On_Close (User : System.Address) is
      Registered : Registration_Access := To_Registration (User);
   begin
      Registered.Gate.Close;
      Leave (Registered);
   exception
      when others =>
         null;
   end On_Close;

   procedure Answer (To : Reply; Result : CDR.Writer) is
      Sink : Errors.Sink;
   begin
      Errors.Check (C.skein_reply_answer (To, Value_Of (Result), Sink.Id), Sink);
   end Answer;

   procedure Push (To : Reply; Item : CDR.Writer) is
      Sink : Errors.Sink;
   begin
      Errors.Check (C.skein_reply_push (To, Value_Of (Item), System.Null_Address, Sink.Id), Sink);
   end Push;

   procedure Refuse (Operation : String) is
   begin
      raise Unimplemented with Operation & "() is not implemented by this service";
   end Refuse;

   function Is_Cancelled return Boolean is
      Sink : Errors.Sink;
      Told : Extensions.bool;
   begin
      Errors.Check (C.skein_reply_cancelled (Current.Value, Told, Sink.Id), Sink);
      return Boolean (Told);
   end Is_Cancelled;

   function Time_Left return Duration is
      Sink : Errors.Sink;
      Left : Interfaces.Integer_64;
   begin
      Errors.Check (C.skein_reply_time_left (Current.Value, Left, Sink.Id), Sink);
      return C.Seconds (Left);
   end Time_Left;

   function Provide (Own : Entities.Entity'Class; Of_Type : Types.Description; By : Handler_Access; Given : Options) return Provider is
      Pairs      : chars_ptr_array (1 .. 2 * size_t (Given.Attributes.Length));
      Next       : size_t := 1;
      Csp        : chars_ptr := (if Given.CSP = "" then Null_Ptr else New_String (To_String (Given.CSP)));
      Owner      : chars_ptr := (if Given.Owner = "" then Null_Ptr else New_String (To_String (Given.Owner)));
      Registered : constant Registration_Access := new Registration;
      Done       : Extensions.bool;
      Sink       : Errors.Sink;
   begin
      Registered.Handler := By;
      for Each in Given.Attributes.Iterate loop
         Pairs (Next) := New_String (Attribute_Maps.Key (Each));
         Pairs (Next + 1) := New_String (Attribute_Maps.Element (Each));
         Next := Next + 2;
      end loop;
      return Made : Provider do
         Done := C.skein_provider_new
           (Own.Handle, Types.Handle (Of_Type),
            (Attributes => Pairs'Address, Attributes_Size => Pairs'Length / 2, Csp => Csp, Owner => Owner,
             Threads => size_t (Given.Threads), Queue => size_t (Given.Queue), others => <>),
            (To_Address (Registered), On_Call'Address, On_Close'Address), Made.Handle, Sink.Id);
         Free (Csp);
         Free (Owner);
         for Each of Pairs loop
            Free (Each);
         end loop;
         Made.Registered := Registered;
         if not Done then
            Free_All (Made.Registered);
         end if;
         Errors.Check (Done, Sink);
      end return;
   end Provide;

   overriding procedure Finalize (Self : in out Provider) is
      Sink : Errors.Sink;
   begin
      if Self.Registered = null then
         return;
      elsif Boolean (C.skein_provider_free (Self.Handle, Sink.Id)) then
         Self.Registered.Gate.Wait;
      else
         Self.Registered.Gate.Detach;
         Log (Skein.Error, "ada", "a provider goes on until its entity ends, and refuses all calls: " & Gates.Gone);
      end if;
      Leave (Self.Registered);
   end Finalize;

end Skein.Services;
