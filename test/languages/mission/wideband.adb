with Ada.Command_Line;
with Ada.Environment_Variables;
with Ada.Text_IO;
with Skein.Entities;
with Skein.Services;
with Threats_IDL;
with Wideband_Csp;

--  A CSP of the Radar Warner in a process of its own: wideband DOMAIN VENDOR.
procedure Wideband is

   use Skein;

   Own : constant Entities.Entity := Entities.Join
     ("wideband", Vendor => Ada.Command_Line.Argument (2), System => "uav-1", Domain => Natural'Value (Ada.Command_Line.Argument (1)));
   Csp     : aliased Wideband_Csp.Wideband;
   Options : Services.Options := (CSP => +"Wideband", Owner => +"uav-1/radar_warner", others => <>);
   Ready   : Ada.Text_IO.File_Type;
begin
   Options.Attributes.Include ("latency", "1 ms");
   Options.Attributes.Include ("quality", "0.9");
   declare
      Provider : constant Services.Provider := Threats_IDL.Recon.IEmitterClassifier.Provide (Own, Csp'Access, Options) with Unreferenced;
   begin
      Ada.Text_IO.Create (Ready, Ada.Text_IO.Out_File, "/proc/self/fd/" & Ada.Environment_Variables.Value ("SKEIN_READY_FD"));
      Ada.Text_IO.Put_Line (Ready, "ready");
      Ada.Text_IO.Close (Ready);
      Wait_For_Signal;
   end;
end Wideband;
