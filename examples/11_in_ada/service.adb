with Greeter_IDL;
with Polite;
with Skein.Entities;
with Skein.Services;

procedure Service is
   Host     : constant Skein.Entities.Entity := Skein.Entities.Join ("host");
   Greeter  : aliased Polite.Greeter;
   Provider : constant Skein.Services.Provider := Greeter_IDL.Greeting.IGreeter.Provide (Host, Greeter'Access) with Unreferenced;
begin
   Skein.Wait_For_Signal;
end Service;
