with Skein.Services;

package body Table_Services is

   use Skein;
   use type Interfaces.Unsigned_8;

   --  Calls that have begun, and that were cancelled.
   protected Counts is
      procedure Begin_One;
      procedure Cancel_One;
      function Begun return Natural;
      function Cancelled return Natural;
   private
      Begun_Count, Cancelled_Count : Natural := 0;
   end Counts;

   protected body Counts is
      procedure Begin_One is
      begin
         Begun_Count := Begun_Count + 1;
      end Begin_One;

      procedure Cancel_One is
      begin
         Cancelled_Count := Cancelled_Count + 1;
      end Cancel_One;

      function Begun return Natural is (Begun_Count);
      function Cancelled return Natural is (Cancelled_Count);
   end Counts;

   overriding function Wind
     (Self : in out Buoy; Level : Interfaces.Unsigned_8; IDL_At : Long_Float; Stamp : out Long_Long_Integer) return Harbour.Wind is
   begin
      if Level = 0 then
         Harbour.Raise_Fog ((Why => +"it lies low", Sight_M => IDL_At));
      end if;
      Stamp := 77;
      return (Level, IDL_At * 2.0, Harbour.Starboard);
   end Wind;

   overriding function Greet (Self : in out Buoy; Name : String) return String is
     (if Name = "begun" then Counts.Begun'Image & " begun"
      elsif Name = "cancelled" then Counts.Cancelled'Image & " cancelled"
      else "Ahoy, " & Name);

   overriding procedure Gusts (Self : in out Buoy; Count : Integer; Push : not null access procedure (Item : Harbour.Wind)) is
   begin
      for I in 0 .. Count - 1 loop
         Push ((Interfaces.Unsigned_8 (I), Long_Float (I) + 0.5, Harbour.Port));
      end loop;
   end Gusts;

   overriding function After (Self : in out Buoy; Ms : Integer) return Integer is
   begin
      Counts.Begin_One;
      for Left in reverse 1 .. Ms loop
         if Skein.Services.Is_Cancelled then
            Counts.Cancel_One;
            exit;
         end if;
         delay 0.001;
      end loop;
      return Ms;
   end After;

   overriding function Report (Self : in out Reporter; Earlier : Harbour.Report) return Harbour.Report is
     ((Earlier.Winds, +"Ada", Earlier.Depth_M));

   protected body Heard is
      procedure Put (Item : Harbour.Depth) is
      begin
         Value := Item;
         Is_There := True;
      end Put;

      entry Get (Item : out Harbour.Depth) when Is_There is
      begin
         Item := Value;
      end Get;
   end Heard;

   overriding procedure Receive (Self : in out Ear; Item : Harbour.Depth) is
   begin
      Heard.Put (Item);
   end Receive;

end Table_Services;
