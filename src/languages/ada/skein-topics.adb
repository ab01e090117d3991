with Ada.Exceptions;
with Ada.Strings.Unbounded;
with Ada.Unchecked_Conversion;
with Ada.Unchecked_Deallocation;
with Interfaces.C.Extensions;
with Skein.C;
with Skein.Errors;
with Skein.Gates;
with System;

package body Skein.Topics is

   use Interfaces.C;

   --  What C holds; see Skein.Services.
   type Registration is limited record
      To   : access Listener'Class;
      Gate : Gates.Gate;
   end record;
   function To_Address is new Ada.Unchecked_Conversion (Registration_Access, System.Address);
   function To_Registration is new Ada.Unchecked_Conversion (System.Address, Registration_Access);
   procedure Free is new Ada.Unchecked_Deallocation (Registration, Registration_Access);

   procedure Leave (Item : in out Registration_Access) is
      Is_Last : Boolean;
   begin
      Item.Gate.Leave (Is_Last);
      if Is_Last then
         Free (Item);
      end if;
      Item := null;
   end Leave;

   Type_Name : constant char_array := To_C (Ada.Strings.Unbounded.To_String (Of_Type.Name));

   --  Nothing that they raise may pass: C calls them.
   procedure On_Value (User : System.Address; Item : access constant C.Value) with Convention => C;
   procedure On_Close (User : System.Address) with Convention => C;

   procedure Tell (Registered : Registration_Access; Item : C.Value) is
      From : CDR.Reader := CDR.Read (Item.Data, CDR.Offset (Item.Size));
      Told : Value;
   begin
      Get (From, Told);
      if not Registered.Gate.Is_Detached then
         Registered.To.Receive (Told);
      end if;
   end Tell;

   procedure On_Value (User : System.Address; Item : access constant C.Value) is
   begin
      begin
         Tell (To_Registration (User), Item.all);
      exception
         when Error : others =>
            Log (Skein.Error, "ada", "a subscriber has raised " & Ada.Exceptions.Exception_Information (Error));
      end;
   exception
      when others =>
         null;  --  not even the log could be told
   end On_Value;

   procedure On_Close (User : System.Address) is
      Registered : Registration_Access := To_Registration (User);
   begin
      Registered.Gate.Close;
      Leave (Registered);
   exception
      when others =>
         null;
   end On_Close;

   function Options (By : Profile; Period : Duration) return C.Topic_Options is
     ((Profile => Profile'Pos (By), Period => C.Nanoseconds (Period), others => <>));

   function Publish_On
     (Own : Entities.Entity'Class; Topic : String; By : Profile := Every_Value; Period : Duration := 0.0) return Publisher
   is
      Sink : Errors.Sink;
   begin
      return Made : Publisher do
         Errors.Check
           (C.skein_publisher_new
              (Own.Handle, Types.Handle (Of_Type.Types), Type_Name, To_C (Topic), Options (By, Period), Made.Handle, Sink.Id), Sink);
      end return;
   end Publish_On;

   procedure Publish (Self : Publisher; Item : Value) is
      Sink : Errors.Sink;
      Into : CDR.Writer (Of_Type.Representation);
   begin
      Put (Into, Item);
      Errors.Check (C.skein_publisher_publish (Self.Handle, (Into.Address, size_t (Into.Size), others => <>), Sink.Id), Sink);
   end Publish;

   function Subscribers (Self : Publisher) return Natural is
      Sink  : Errors.Sink;
      Count : size_t;
   begin
      Errors.Check (C.skein_publisher_subscribers (Self.Handle, Count, Sink.Id), Sink);
      return Natural (Count);
   end Subscribers;

   function Subscribe
     (Own : Entities.Entity'Class; Topic : String; To : not null access Listener'Class; By : Profile := Every_Value;
      Period : Duration := 0.0) return Subscription
   is
      Sink       : Errors.Sink;
      Done       : Extensions.bool;
      Registered : constant Registration_Access := new Registration;
   begin
      Registered.To := To.all'Unchecked_Access;
      return Made : Subscription do
         Done := C.skein_subscription_new
           (Own.Handle, Types.Handle (Of_Type.Types), Type_Name, To_C (Topic), Options (By, Period),
            (To_Address (Registered), On_Value'Address, On_Close'Address), Made.Handle, Sink.Id);
         Made.Registered := Registered;
         if not Done then
            Free (Made.Registered);
         end if;
         Errors.Check (Done, Sink);
      end return;
   end Subscribe;

   function Publishers (Self : Subscription) return Natural is
      Sink  : Errors.Sink;
      Count : size_t;
   begin
      Errors.Check (C.skein_subscription_publishers (Self.Handle, Count, Sink.Id), Sink);
      return Natural (Count);
   end Publishers;

   procedure Ignore (Done : Extensions.bool) is null;

   overriding procedure Finalize (Self : in out Publisher) is
   begin
      Ignore (C.skein_publisher_free (Self.Handle, C.None));
      Self.Handle := C.None;
   end Finalize;

   overriding procedure Finalize (Self : in out Subscription) is
      Sink : Errors.Sink;
   begin
      if Self.Registered = null then
         return;
      elsif Boolean (C.skein_subscription_free (Self.Handle, Sink.Id)) then
         Self.Registered.Gate.Wait;
      else
         Self.Registered.Gate.Detach;
         Log (Skein.Error, "ada", "a subscription goes on until its entity ends, and drops all values: " & Gates.Gone);
      end if;
      Leave (Self.Registered);
   end Finalize;

end Skein.Topics;
