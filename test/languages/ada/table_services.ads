with Buoy_IDL;
with Interfaces;
with Skein.Topics;

--  What the peer of the table provides, and hears.
package Table_Services is

   use Buoy_IDL;

   type Buoy is new Harbour.IBuoy.Service with null record;
   overriding function Wind
     (Self : in out Buoy; Level : Interfaces.Unsigned_8; IDL_At : Long_Float; Stamp : out Long_Long_Integer) return Harbour.Wind;
   overriding function Greet (Self : in out Buoy; Name : String) return String;
   overriding procedure Forget (Self : in out Buoy) is null;
   overriding procedure Gusts (Self : in out Buoy; Count : Integer; Push : not null access procedure (Item : Harbour.Wind));
   overriding function After (Self : in out Buoy; Ms : Integer) return Integer;

   type Reporter is new Harbour.IReporter.Service with null record;
   overriding function Report (Self : in out Reporter; Earlier : Harbour.Report) return Harbour.Report;

   package Depths is new Skein.Topics (Harbour.Depth, Harbour.Depth_Topic_Type, Harbour.Put, Harbour.Get);

   --  What was heard last.
   protected Heard is
      procedure Put (Item : Harbour.Depth);
      entry Get (Item : out Harbour.Depth);
   private
      Value    : Harbour.Depth;
      Is_There : Boolean := False;
   end Heard;

   type Ear is limited new Depths.Listener with null record;
   overriding procedure Receive (Self : in out Ear; Item : Harbour.Depth);

end Table_Services;
