with Ada.Command_Line;
with Ada.Strings.Unbounded;
with Ada.Text_IO;
with Buoy_IDL;
with Interfaces;
with Skein.Entities;
with Skein.Proxies;
with Skein.Services;
with Table_Services;

--  One side of the table of languages, in Ada: table_peer VENDOR SHARED_MEMORY provide|check. See table.py.
procedure Table_Peer is

   use Ada.Strings.Unbounded;
   use Buoy_IDL;
   use Skein;
   use type Interfaces.Unsigned_8;
   use type Harbour.Depth;
   use type Harbour.Wind;

   Quay : constant Harbour.Depth := (+"quay", 4.5);

   procedure Provide (Own : Entities.Entity'Class) is
      Service : aliased Table_Services.Buoy;
      Csp     : aliased Table_Services.Reporter;
      Serving : constant Services.Provider := Harbour.IBuoy.Provide (Own, Service'Access, (Threads => 3, others => <>)) with Unreferenced;
      Judged  : constant Services.Provider :=
        Harbour.IReporter.Provide (Own, Csp'Access, (CSP => +"Ada", Owner => +"uav-1/checker", others => <>)) with Unreferenced;
      Told    : constant Table_Services.Depths.Publisher := Table_Services.Depths.Publish_On (Own, "depth", Table_Services.Depths.State);
   begin
      Told.Publish (Quay);
      Ada.Text_IO.Put_Line ("provides");
      Ada.Text_IO.Flush;
      while not Ada.Text_IO.End_Of_File loop
         Ada.Text_IO.Skip_Line;
      end loop;
   end Provide;

   procedure Tell (Feature : String; Right : Boolean) is
   begin
      Ada.Text_IO.Put_Line (Feature & (if Right then " ok" else " wrong"));
      Ada.Text_IO.Flush;
   end Tell;

   function Calls (Buoy : Harbour.IBuoy.Proxy) return Boolean is
      Stamp : Long_Long_Integer;
      Wind  : constant Harbour.Wind := Buoy.Wind (3, 1.5, Stamp);
   begin
      return Wind = Buoy.Wind (0, 1.25, Stamp);
   exception
      when Error : Harbour.Fog =>
         return Wind = (3, 3.0, Harbour.Starboard) and Stamp = 77 and Harbour.Fog_Of (Error).Why = "it lies low"
           and Harbour.Fog_Of (Error).Sight_M = 1.25;
   end Calls;

   function Calls_Later (Buoy : Harbour.IBuoy.Proxy) return Boolean is
      Begun : array (1 .. 20) of Proxies.Pending;
   begin
      for I in Begun'Range loop
         Buoy.Start_Greet (Begun (I), I'Image);
      end loop;
      return (for all I in Begun'Range => Harbour.IBuoy.Finish_Greet (Begun (I)) = "Ahoy, " & I'Image);
   end Calls_Later;

   function Streams (Buoy : Harbour.IBuoy.Proxy) return Boolean is
      Gusts : Harbour.IBuoy.Gusts_Stream := Buoy.Gusts (20);
      Gust  : Harbour.Wind;
      Next  : Interfaces.Unsigned_8 := 0;
   begin
      while Gusts.Next (Gust) loop
         if Gust.Force /= Next then
            return False;
         end if;
         Next := Next + 1;
      end loop;
      return Next = 20;
   end Streams;

   function Subscribes (Own : Entities.Entity'Class) return Boolean is
      Listener     : aliased Table_Services.Ear;
      Subscription : constant Table_Services.Depths.Subscription := Table_Services.Depths.Subscribe (Own, "depth", Listener'Access, Table_Services.Depths.State) with Unreferenced;
      Depth        : Harbour.Depth;
   begin
      Table_Services.Heard.Get (Depth);
      return Depth = Quay;
   end Subscribes;

   --  Until the provider has counted one.
   procedure Await (Buoy : Harbour.IBuoy.Proxy; What : String) is
   begin
      while Buoy.Greet (What) = " 0 " & What loop
         delay 0.002;
      end loop;
   end Await;

   function Cancels (Buoy : Harbour.IBuoy.Proxy) return Boolean is
      Slow : Proxies.Pending;
   begin
      Buoy.Start_After (Slow, 60_000);
      Await (Buoy, "begun");
      Slow.Cancel;
      Await (Buoy, "cancelled");
      return True;
   end Cancels;

   function Keeps_Deadlines (Buoy : Harbour.IBuoy.Proxy) return Boolean is
   begin
      return Buoy.After (60_000, Within => 0.1) < 0;
   exception
      when Timed_Out =>
         return True;
   end Keeps_Deadlines;

   procedure Check (Own : Entities.Entity'Class) is
      Buoy : constant Harbour.IBuoy.Proxy := Harbour.IBuoy.Connect (Own, (Timeout => 30.0, others => <>));
   begin
      Tell ("call", Calls (Buoy));
      Tell ("asynchronous", Calls_Later (Buoy));
      Tell ("stream", Streams (Buoy));
      Tell ("topics", Subscribes (Own));
      Tell ("cancel", Cancels (Buoy));
      Tell ("deadline", Keeps_Deadlines (Buoy));
   end Check;

   Provides : constant Boolean := Ada.Command_Line.Argument (3) = "provide";
   Own      : constant Entities.Entity := Entities.Join
     ((if Provides then "provider" else "checker"), Vendor => Ada.Command_Line.Argument (1), System => "uav-1", Domain => 17,
      Shared_Memory_Calls => Ada.Command_Line.Argument (2) = "yes", Lease => 60.0);
begin
   if Provides then
      Provide (Own);
   else
      Check (Own);
   end if;
end Table_Peer;
