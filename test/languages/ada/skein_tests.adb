with Ada.Environment_Variables;
with Ada.Exceptions;
with Ada.Numerics;
with Ada.Strings.Fixed;
with Ada.Strings.Unbounded;
with Ada.Strings.Wide_Unbounded;
with AUnit.Assertions;
with Buoy_IDL;
with GNAT.Expect;
with GNAT.OS_Lib;
with Interfaces;
with Skein.Entities;
with Skein.Errors;
with Skein.Proxies;
with Skein.Sequences.Integers;
with Skein.Services;
with Skein.Topics;

package body Skein_Tests is

   use Ada.Strings.Unbounded;
   use AUnit.Assertions;
   use AUnit.Test_Cases.Registration;
   use Buoy_IDL;
   use Skein;
   use type GNAT.Expect.Expect_Match;
   use type Harbour.Cargo;
   use type Harbour.Dangers;
   use type Harbour.Report;
   use type Harbour.Wind;
   use type Interfaces.Unsigned_8;

   Pairing  : constant String := Ada.Environment_Variables.Value ("SKEIN_PAIRING", "loopback:loopback");
   Colon    : constant Positive := Ada.Strings.Fixed.Index (Pairing, ":");
   Server   : constant String := Pairing (Pairing'First .. Colon - 1);
   Client   : constant String := Pairing (Colon + 1 .. Pairing'Last);
   Patience : constant Duration := 30.0;

   type Long_Float_List is array (Positive range <>) of Long_Float;

   function Is_On_A_Wire return Boolean is (Server /= "loopback");

   function Join (Name, Vendor : String; Lease : Duration := 0.0) return Entities.Entity is
     (Entities.Join (Name, Vendor => Vendor, System => "uav-1", Domain => 17, Lease => Lease));

   function Meets (Own : Entities.Entity'Class) return Harbour.IBuoy.Proxy is
     (Harbour.IBuoy.Connect (Own, (Timeout => Patience, others => <>)));

   procedure Eventually (Condition : not null access function return Boolean; What : String) is
   begin
      for Try in 1 .. Integer (Patience / 0.002) loop
         exit when Condition.all;
         delay 0.002;
      end loop;
      Assert (Condition.all, What);
   end Eventually;

   --  Whether the call raises the exception with such a text.
   procedure Assert_Raises
     (Call : not null access procedure; Expected : Ada.Exceptions.Exception_Id; Text : String)
   is
      use type Ada.Exceptions.Exception_Id;
   begin
      Call.all;
      Assert (False, Ada.Exceptions.Exception_Name (Expected) & " was not raised");
   exception
      when Error : others =>
         Assert
           (Ada.Exceptions.Exception_Identity (Error) = Expected 
              and (Text = "" or else Ada.Strings.Fixed.Index (Errors.Text (Error), Text) > 0),
            Ada.Exceptions.Exception_Name (Error) & ": " & Errors.Text (Error));
   end Assert_Raises;

   --  ---- values

   --  What a subscriber gets of what is published.
   generic
      type Value is private;
      with package Of_Type is new Skein.Topics (Value => Value, others => <>);
   package Round_Trips is
      function Back (Item : Value) return Value;
   end Round_Trips;

   package body Round_Trips is

      protected Told is
         procedure Put (Item : Value);
         entry Get (Item : out Value);
      private
         Kept     : Value;
         Is_There : Boolean := False;
      end Told;

      protected body Told is
         procedure Put (Item : Value) is
         begin
            Kept := Item;
            Is_There := True;
         end Put;

         entry Get (Item : out Value) when Is_There is
         begin
            Item := Kept;
            Is_There := False;
         end Get;
      end Told;

      type Ear is limited new Of_Type.Listener with null record;
      overriding procedure Receive (Self : in out Ear; Item : Value);
      overriding procedure Receive (Self : in out Ear; Item : Value) is
      begin
         Told.Put (Item);
      end Receive;

      function Back (Item : Value) return Value is
         Own          : constant Entities.Entity := Join ("values", "loopback");
         Publisher    : constant Of_Type.Publisher := Of_Type.Publish_On (Own, "values", Of_Type.State);
         Listener     : aliased Ear;
         Subscription : constant Of_Type.Subscription := Of_Type.Subscribe (Own, "values", Listener'Access, Of_Type.State)
           with Unreferenced;
         Got          : Value;
      begin
         Publisher.Publish (Item);
         Told.Get (Got);
         return Got;
      end Back;

   end Round_Trips;

   package Cargos is new Skein.Topics (Harbour.Cargo, Harbour.Cargo_Topic_Type, Harbour.Put, Harbour.Get);
   package Cargo_Trips is new Round_Trips (Harbour.Cargo, Cargos);
   function Back (Item : Harbour.Cargo) return Harbour.Cargo renames Cargo_Trips.Back;

   function A_Cargo return Harbour.Cargo is
      Row : Sequences.Integers.Vector;
   begin
      return Made : Harbour.Cargo do
         Made.Name := Ada.Strings.Wide_Unbounded.To_Unbounded_Wide_String ("wide " & Wide_Character'Val (16#D83D#) & Wide_Character'Val (16#DC1F#));
         Made.Dangers := Harbour.Dangers_Fire or Harbour.Dangers_Poison;
         Made.Seal := (Ring => 5, Number => 31);
         Made.Sides (1) (2) := 4.5;
         Row.Append (1);
         Row.Append (-2);
         Made.Shelves.Append (Row);
         Made.Winds.Insert (+"bow", (1, 2.5, Harbour.Starboard));
         Made.Content := Harbour.Optional_Content.Given ((Switch => Harbour.Large, Winds => Harbour.Wind_Sequences.To_Vector (2)));
         Made.Inner.Append (Harbour.To_Box ((Mark => 'i', others => <>)));
         Made.Mark := 'm';
         Made.Letter := Wide_Character'Val (16#416#);
         Made.Fragile := True;
         Made.Exact := -0.375;
         Made.Depth := Harbour.Optional_Depth.Given ((+"quay", 3.5));
         Made.Names.Append (+"");
      end return;
   end A_Cargo;

   procedure Every_Kind_Comes_Back (T : in out AUnit.Test_Cases.Test_Case'Class) is
      pragma Unreferenced (T);
      Empty : Harbour.Cargo;
      Got   : constant Harbour.Cargo := Back (A_Cargo);
   begin
      Assert (Got = A_Cargo, "not all came back");
      Assert (Harbour.From_Box (Got.Inner (1)).Mark = 'i', "what is within");
      Assert (Back (Empty) = Empty, "initial values");
   end Every_Kind_Comes_Back;

   procedure Long_Doubles_Keep_A_Double (T : in out AUnit.Test_Cases.Test_Case'Class) is
      pragma Unreferenced (T);
      Item : Harbour.Cargo;
   begin
      for Each of Long_Float_List'(0.0, 1.0, -1.0E300, 1.0E-300, Long_Float'Last, Long_Float'Model_Small, Ada.Numerics.Pi) loop
         Item.Exact := Long_Long_Float (Each);
         Assert (Long_Float (Back (Item).Exact) = Each, Each'Image);
      end loop;
   end Long_Doubles_Keep_A_Double;

   procedure What_Fits_Nowhere_Is_Refused_With_Its_Place (T : in out AUnit.Test_Cases.Test_Case'Class) is
      pragma Unreferenced (T);
      Item : Harbour.Cargo := A_Cargo;

      procedure Send is
         Ignored : constant Harbour.Cargo := Back (Item) with Unreferenced;
      begin
         null;
      end Send;
   begin
      Item.Seal.Ring := 8;
      Assert_Raises (Send'Access, Invalid_Argument'Identity, "harbour::Seal.ring has 3 bits, and was given 8");
      Item := A_Cargo;
      Item.Content := Harbour.Optional_Content.Given ((Harbour.Small, Label => 41 * "x"));
      Assert_Raises (Send'Access, Invalid_Argument'Identity, "harbour::Content.label takes 40 at most, and was given 41");
      Item := A_Cargo;
      Item.Names.Append (+("a" & ASCII.NUL));
      Assert_Raises (Send'Access, Invalid_Argument'Identity, "harbour::Cargo.names has a character of 0");
   end What_Fits_Nowhere_Is_Refused_With_Its_Place;

   overriding function Name (T : Values) return AUnit.Message_String is (AUnit.Format ("values"));

   overriding procedure Register_Tests (T : in out Values) is
   begin
      Register_Routine (T, Every_Kind_Comes_Back'Access, "a value of every kind comes back");
      Register_Routine (T, Long_Doubles_Keep_A_Double'Access, "a long double keeps what a double has");
      Register_Routine (T, What_Fits_Nowhere_Is_Refused_With_Its_Place'Access, "what fits nowhere is refused with its place");
   end Register_Tests;

   --  ---- calls

   protected Counts is
      procedure Count_Forgotten;
      procedure Count_Begun;
      procedure Count_Cancelled;
      procedure Clear;
      function Forgotten return Natural;
      function Begun return Natural;
      function Cancelled return Natural;
   private
      Forgotten_Calls, Begun_Calls, Cancelled_Calls : Natural := 0;
   end Counts;

   protected body Counts is
      procedure Count_Forgotten is
      begin
         Forgotten_Calls := Forgotten_Calls + 1;
      end Count_Forgotten;

      procedure Count_Begun is
      begin
         Begun_Calls := Begun_Calls + 1;
      end Count_Begun;

      procedure Count_Cancelled is
      begin
         Cancelled_Calls := Cancelled_Calls + 1;
      end Count_Cancelled;

      procedure Clear is
      begin
         Forgotten_Calls := 0;
         Begun_Calls := 0;
         Cancelled_Calls := 0;
      end Clear;

      function Forgotten return Natural is (Forgotten_Calls);
      function Begun return Natural is (Begun_Calls);
      function Cancelled return Natural is (Cancelled_Calls);
   end Counts;

   function Has_Forgotten return Boolean is (Counts.Forgotten > 0);
   function Has_Begun return Boolean is (Counts.Begun > 0);
   function Has_Cancelled return Boolean is (Counts.Cancelled > 0);

   type Buoy is new Harbour.IBuoy.Service with null record;
   overriding function Wind
     (Self : in out Buoy; Level : Interfaces.Unsigned_8; IDL_At : Long_Float; Stamp : out Long_Long_Integer) return Harbour.Wind;
   overriding function Greet (Self : in out Buoy; Name : String) return String;
   overriding procedure Forget (Self : in out Buoy);
   overriding procedure Gusts (Self : in out Buoy; Count : Integer; Push : not null access procedure (Item : Harbour.Wind));
   overriding function After (Self : in out Buoy; Ms : Integer) return Integer;

   overriding function Wind
     (Self : in out Buoy; Level : Interfaces.Unsigned_8; IDL_At : Long_Float; Stamp : out Long_Long_Integer) return Harbour.Wind is
   begin
      if Level = 0 then
         Harbour.Raise_Fog ((+"it lies low", IDL_At));
      elsif Level = 1 then
         raise Harbour.Fog;
      end if;
      Stamp := 77;
      return (Level, IDL_At * 2.0, Harbour.Starboard);
   end Wind;

   overriding function Greet (Self : in out Buoy; Name : String) return String is
   begin
      if Name = "late" then
         raise Overloaded with "not now";
      elsif Name = "bug" then
         raise Constraint_Error with "a mistake";
      elsif Name = "nobody" then
         Counts.Count_Begun;
         return "" & Character'Val (Self.After (60_000) mod 2);
      end if;
      if Name'Length > 1_000_000 then
         return Name;  --  to join texts of this size takes more than the thread's stack
      end if;
      return "Ahoy, " & Name;
   end Greet;

   overriding procedure Forget (Self : in out Buoy) is
   begin
      Counts.Count_Forgotten;
   end Forget;

   overriding procedure Gusts (Self : in out Buoy; Count : Integer; Push : not null access procedure (Item : Harbour.Wind)) is
   begin
      for I in 0 .. Count - 1 loop
         Push ((Interfaces.Unsigned_8 (I mod 256), Long_Float (I) + 0.5, Harbour.Port));
      end loop;
   end Gusts;

   overriding function After (Self : in out Buoy; Ms : Integer) return Integer is
   begin
      Counts.Count_Begun;
      for Left in 1 .. Ms loop
         if Services.Is_Cancelled then
            Counts.Count_Cancelled;
            return Left;
         end if;
         delay 0.001;
      end loop;
      return Ms;
   end After;

   type Reporter is new Harbour.IReporter.Service with null record;
   overriding function Report (Self : in out Reporter; Earlier : Harbour.Report) return Harbour.Report is
     ((Earlier.Winds, Earlier.Place & " again", Harbour.Optional_Long_Float.None));

   Served   : aliased Buoy;
   Reported : aliased Reporter;
   Threads  : constant Services.Options := (Threads => 3, others => <>);

   procedure Calls_Bring_Results_And_Exceptions (T : in out AUnit.Test_Cases.Test_Case'Class) is
      pragma Unreferenced (T);
      Host     : constant Entities.Entity := Join ("server", Server);
      Guest    : constant Entities.Entity := Join ("client", Client);
      Provider : constant Services.Provider := Harbour.IBuoy.Provide (Host, Served'Access, Threads) with Unreferenced;
      Proxy    : constant Harbour.IBuoy.Proxy := Meets (Guest);
      Stamp    : Long_Long_Integer;
      Earlier  : Harbour.Report;
      Report   : constant Services.Provider := Harbour.IReporter.Provide (Host, Reported'Access) with Unreferenced;

      procedure Raise_Late is
      begin
         Assert (Proxy.Greet ("late") = "", "");
      end Raise_Late;

      procedure Raise_Bug is
      begin
         Assert (Proxy.Greet ("bug") = "", "");
      end Raise_Bug;

      procedure Raise_Bare is
      begin
         Assert (Proxy.Wind (1, 1.0, Stamp).Force = 0, "");
      end Raise_Bare;
   begin
      Counts.Clear;
      Assert (Host.Id = "uav-1/server", Host.Id);
      Assert (Proxy.Greet ("w" & Character'Val (16#C3#) & Character'Val (16#B6#) & "rld") = "Ahoy, w" & Character'Val (16#C3#) & Character'Val (16#B6#) & "rld", "UTF-8");
      Assert (Proxy.Wind (3, 1.5, Stamp) = (3, 3.0, Harbour.Starboard) and Stamp = 77, "a result and an out parameter");
      begin
         Assert (Proxy.Wind (0, 1.25, Stamp).Force = 9, "Fog was not raised");
      exception
         when Error : Harbour.Fog =>
            Assert (Harbour.Fog_Of (Error).Why = "it lies low" and Harbour.Fog_Of (Error).Sight_M = 1.25, "the members of Fog");
      end;
      Proxy.Forget;
      Eventually (Has_Forgotten'Access, "a oneway operation runs");
      Earlier.Place := +"quay";
      Earlier.Winds.Append ((9, 1.0, Harbour.Port));
      Earlier.Depth_M := Harbour.Optional_Long_Float.Given (3.5);
      Assert
        (Harbour.IReporter.Connect (Guest, (Timeout => Patience, others => <>)).Report (Earlier)
           = (Earlier.Winds, +"quay again", Harbour.Optional_Long_Float.None), "types that grow");
      Assert_Raises (Raise_Late'Access, Overloaded'Identity, "not now");
      Assert_Raises (Raise_Bug'Access, Internal'Identity, "CONSTRAINT_ERROR: a mistake");
      Assert_Raises (Raise_Bare'Access, Internal'Identity, "raise it by its Raise_ procedure");
   end Calls_Bring_Results_And_Exceptions;

   procedure Answers_May_Be_Long (T : in out AUnit.Test_Cases.Test_Case'Class) is
      pragma Unreferenced (T);
      Host     : constant Entities.Entity := Join ("server", Server);
      Guest    : constant Entities.Entity := Join ("client", Client);
      Provider : constant Services.Provider := Harbour.IBuoy.Provide (Host, Served'Access, Threads) with Unreferenced;
      Proxy    : constant Harbour.IBuoy.Proxy := Meets (Guest);
      Long     : constant Unbounded_String := 12_000_000 * "a";  --  more than the stack of a thread holds
      Answer   : Unbounded_String;
   begin
      Set_Unbounded_String (Answer, Proxy.Greet (To_String (Long), Within => Patience));
      Assert (Answer = Long, "all of it came back");
   end Answers_May_Be_Long;

   procedure Each_Exception_Keeps_Its_Members (T : in out AUnit.Test_Cases.Test_Case'Class) is
      pragma Unreferenced (T);
   begin
      Harbour.Raise_Fog ((+"first", 1.0));
   exception
      when First : Harbour.Fog =>
         begin
            Harbour.Raise_Fog ((+"second", 2.0));
         exception
            when Second : Harbour.Fog =>
               Assert (Harbour.Fog_Of (Second).Why = "second", "the second");
         end;
         Assert (Harbour.Fog_Of (First).Why = "first", "the first, after the second");
   end Each_Exception_Keeps_Its_Members;

   procedure The_End_Of_A_Provider_Waits_For_Its_Calls (T : in out AUnit.Test_Cases.Test_Case'Class) is
      pragma Unreferenced (T);
      Host  : constant Entities.Entity := Join ("server", Server);
      Guest : constant Entities.Entity := Join ("client", Client);
      Call  : Proxies.Pending;
   begin
      Counts.Clear;
      declare
         Short_Lived : aliased Buoy;
         Provider    : constant Services.Provider := Harbour.IBuoy.Provide (Host, Short_Lived'Access, Threads) with Unreferenced;
         Proxy       : constant Harbour.IBuoy.Proxy := Meets (Guest);
      begin
         Proxy.Start_After (Call, 60_000);
         Eventually (Has_Begun'Access, "the call begins");
      end;
      Assert (Has_Cancelled, "the service was called to its end");
   end The_End_Of_A_Provider_Waits_For_Its_Calls;

   procedure Many_Tasks_Call_At_Once (T : in out AUnit.Test_Cases.Test_Case'Class) is
      pragma Unreferenced (T);
      Host     : constant Entities.Entity := Join ("server", Server);
      Guest    : constant Entities.Entity := Join ("client", Client);
      Provider : constant Services.Provider := Harbour.IBuoy.Provide (Host, Served'Access, Threads) with Unreferenced;
      Proxy    : constant Harbour.IBuoy.Proxy := Meets (Guest);
      Calls    : constant := 100;

      protected Right is
         procedure Count;
         function Total return Natural;
      private
         Counted : Natural := 0;
      end Right;

      protected body Right is
         procedure Count is
         begin
            Counted := Counted + 1;
         end Count;
         function Total return Natural is (Counted);
      end Right;

      task type Caller;
      task body Caller is
         Stamp : Long_Long_Integer;
      begin
         for I in 1 .. Calls loop
            begin
               if Proxy.Greet (I'Image) = "Ahoy, " & I'Image then
                  Right.Count;
               end if;
               Assert (Proxy.Wind (0, Long_Float (I), Stamp).Force = 9, "");
            exception
               when Error : Harbour.Fog =>
                  if Harbour.Fog_Of (Error).Sight_M = Long_Float (I) then
                     Right.Count;
                  end if;
            end;
         end loop;
      end Caller;
   begin
      declare
         Callers : array (1 .. 8) of Caller with Unreferenced;
      begin
         null;  --  until they have ended
      end;
      Assert (Right.Total = 8 * 2 * Calls, Right.Total'Image);
   end Many_Tasks_Call_At_Once;

   procedure Begun_Calls_End_Or_Are_Cancelled (T : in out AUnit.Test_Cases.Test_Case'Class) is
      pragma Unreferenced (T);
      Host     : constant Entities.Entity := Join ("server", Server);
      Guest    : constant Entities.Entity := Join ("client", Client);
      Provider : constant Services.Provider := Harbour.IBuoy.Provide (Host, Served'Access, Threads) with Unreferenced;
      Proxy    : constant Harbour.IBuoy.Proxy := Meets (Guest);
      Begun    : array (1 .. 50) of Proxies.Pending;
      Slow     : Proxies.Pending;

      procedure Finish_Slow is
      begin
         Assert (Harbour.IBuoy.Finish_After (Slow) = 0, "");
      end Finish_Slow;

      procedure Finish_Nothing is
         Never : Proxies.Pending;
      begin
         Assert (Harbour.IBuoy.Finish_After (Never) = 0, "");
      end Finish_Nothing;

      procedure Finish_Another is
      begin
         Proxy.Start_Greet (Slow, "you");
         Assert (Harbour.IBuoy.Finish_After (Slow) = 0, "");
      end Finish_Another;

      procedure Run_Late is
      begin
         Assert (Proxy.After (60_000, Within => 0.05) = 0, "");
      end Run_Late;
   begin
      Counts.Clear;
      for I in Begun'Range loop
         Proxy.Start_Greet (Begun (I), I'Image);
      end loop;
      for I in Begun'Range loop
         Assert (Harbour.IBuoy.Finish_Greet (Begun (I)) = "Ahoy, " & I'Image, I'Image);
      end loop;
      Proxy.Start_After (Slow, 60_000, Within => 60.0);
      Eventually (Has_Begun'Access, "the call begins");
      Slow.Cancel;
      Eventually (Has_Cancelled'Access, "the provider sees it");
      Assert_Raises (Finish_Slow'Access, Cancelled'Identity, "");
      Assert_Raises (Finish_Nothing'Access, Invalid_Argument'Identity, "was not begun");
      Assert_Raises (Finish_Another'Access, Invalid_Argument'Identity, "a call of greet(), and not of after()");
      Assert_Raises (Run_Late'Access, Timed_Out'Identity, "");
   end Begun_Calls_End_Or_Are_Cancelled;

   procedure Streams_End_Or_Are_Left (T : in out AUnit.Test_Cases.Test_Case'Class) is
      pragma Unreferenced (T);
      Host     : constant Entities.Entity := Join ("server", Server);
      Guest    : constant Entities.Entity := Join ("client", Client);
      Provider : constant Services.Provider := Harbour.IBuoy.Provide (Host, Served'Access, Threads) with Unreferenced;
      Proxy    : constant Harbour.IBuoy.Proxy := Meets (Guest);
      Gust     : Harbour.Wind;
      Count    : Natural := 0;
   begin
      declare
         Gusts : Harbour.IBuoy.Gusts_Stream := Proxy.Gusts (100);
      begin
         while Gusts.Next (Gust) loop
            Assert (Gust.Speed_M_S = Long_Float (Count) + 0.5, Count'Image);
            Count := Count + 1;
         end loop;
      end;
      Assert (Count = 100, Count'Image);
      declare
         Gusts : Harbour.IBuoy.Gusts_Stream := Proxy.Gusts (10_000_000);
      begin
         Assert (Gusts.Next (Gust), "the first");
      end;
      Assert (Proxy.Greet ("again") = "Ahoy, again", "the provider goes on");
   end Streams_End_Or_Are_Left;

   procedure Errors_Say_What_Can_Be_Done (T : in out AUnit.Test_Cases.Test_Case'Class) is
      pragma Unreferenced (T);
      Host     : constant Entities.Entity := Join ("server", Server);
      Guest    : constant Entities.Entity := Join ("client", Client);
      Csp      : constant Services.Options := (CSP => +"Ada", Owner => +Host.Id, others => <>);
      Provider : constant Services.Provider := Harbour.IReporter.Provide (Host, Reported'Access, Csp) with Unreferenced;

      procedure Connect_To_A_Csp is
         Proxy : constant Harbour.IReporter.Proxy := Harbour.IReporter.Connect (Guest, (Timeout => 0.2, others => <>));
      begin
         Assert (Proxy.Report ((others => <>)).Place = "", "");
      end Connect_To_A_Csp;

      procedure Join_Nowhere is
         Nobody : constant Entities.Entity := Join ("nobody", "rtps") with Unreferenced;
      begin
         null;
      end Join_Nowhere;
   begin
      Assert_Raises (Connect_To_A_Csp'Access, Unavailable'Identity, "IReporter");
      Assert_Raises (Join_Nowhere'Access, Invalid_Argument'Identity, "rtps");
   end Errors_Say_What_Can_Be_Done;

   overriding function Name (T : Calls) return AUnit.Message_String is (AUnit.Format (Pairing));

   overriding procedure Register_Tests (T : in out Calls) is
   begin
      Register_Routine (T, Calls_Bring_Results_And_Exceptions'Access, "calls bring results and exceptions");
      Register_Routine (T, Answers_May_Be_Long'Access, "answers may be longer than a stack");
      Register_Routine (T, Each_Exception_Keeps_Its_Members'Access, "each exception keeps its members");
      Register_Routine (T, The_End_Of_A_Provider_Waits_For_Its_Calls'Access, "the end of a provider waits for its calls");
      Register_Routine (T, Many_Tasks_Call_At_Once'Access, "many tasks call at once");
      Register_Routine (T, Begun_Calls_End_Or_Are_Cancelled'Access, "calls that were begun end, or are cancelled");
      Register_Routine (T, Streams_End_Or_Are_Left'Access, "streams end, or are left");
      Register_Routine (T, Errors_Say_What_Can_Be_Done'Access, "errors say what can be done");
   end Register_Tests;

   --  ---- deaths

   --  A peer in C, which waits for the end of its input.
   procedure Start (Peer : in out GNAT.Expect.Process_Descriptor; Vendor, Side : String) is
      Arguments : GNAT.OS_Lib.Argument_List := (new String'(Vendor), new String'(Side));
   begin
      GNAT.Expect.Non_Blocking_Spawn (Peer, Ada.Environment_Variables.Value ("SKEIN_BUOY_PEER"), Arguments);
      for Each of Arguments loop
         GNAT.OS_Lib.Free (Each);
      end loop;
   end Start;

   procedure Await (Peer : in out GNAT.Expect.Process_Descriptor; Line : String) is
      Matched : GNAT.Expect.Expect_Match;
   begin
      GNAT.Expect.Expect (Peer, Matched, Line, Timeout => Integer (Patience) * 1_000);
      Assert (Matched = 1, Line);
   end Await;

   procedure Kill (Peer : in out GNAT.Expect.Process_Descriptor) is
   begin
      GNAT.Expect.Send_Signal (Peer, 9);
      GNAT.Expect.Close (Peer);
   end Kill;

   procedure The_Next_Life_Of_A_Provider_Serves (T : in out AUnit.Test_Cases.Test_Case'Class) is
      pragma Unreferenced (T);
      Guest         : constant Entities.Entity := Join ("mourner", Client, Lease => 60.0);
      First, Second : GNAT.Expect.Process_Descriptor;
      Call          : Proxies.Pending;

      procedure Finish is
      begin
         Assert (Harbour.IBuoy.Finish_Greet (Call) = "", "");
      end Finish;
   begin
      Start (First, Server, "provide");
      declare
         Proxy : constant Harbour.IBuoy.Proxy := Meets (Guest);
      begin
         Proxy.Start_Greet (Call, "nobody", Within => Patience);
         Await (First, "called");
         Kill (First);
         Assert_Raises (Finish'Access, Disconnected'Identity, "");
         Start (Second, Server, "provide");
         Assert (Proxy.Greet ("you", Within => Patience) = "you", "after");
         Kill (Second);
      end;
   end The_Next_Life_Of_A_Provider_Serves;

   procedure The_Death_Of_A_Caller_Cancels_Its_Calls (T : in out AUnit.Test_Cases.Test_Case'Class) is
      pragma Unreferenced (T);
      Host     : constant Entities.Entity := Join ("waiting", Server, Lease => 60.0);
      Provider : constant Services.Provider := Harbour.IBuoy.Provide (Host, Served'Access, Threads) with Unreferenced;
      Peer     : GNAT.Expect.Process_Descriptor;
   begin
      Counts.Clear;
      Start (Peer, Client, "call");
      Eventually (Has_Begun'Access, "the call begins");
      Kill (Peer);
      Eventually (Has_Cancelled'Access, "the provider sees that nobody waits");
   end The_Death_Of_A_Caller_Cancels_Its_Calls;

   overriding function Name (T : Deaths) return AUnit.Message_String is (AUnit.Format ("deaths, " & Pairing));

   overriding procedure Register_Tests (T : in out Deaths) is
   begin
      Register_Routine (T, The_Next_Life_Of_A_Provider_Serves'Access, "a provider's death ends its calls, and its next life serves");
      Register_Routine (T, The_Death_Of_A_Caller_Cancels_Its_Calls'Access, "a caller's death cancels its calls");
   end Register_Tests;

end Skein_Tests;
