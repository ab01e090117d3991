with Ada.Text_IO;
with Greeter_IDL;
with Skein.Entities;
with Skein.Proxies;

procedure Caller is

   use Greeter_IDL;

   Guest   : constant Skein.Entities.Entity := Skein.Entities.Join ("guest", Vendor => "fastdds");
   Greeter : constant Greeting.IGreeter.Proxy := Greeting.IGreeter.Connect (Guest);
   Later   : Skein.Proxies.Pending;
begin
   Ada.Text_IO.Put_Line (Greeter.Greet ("world"));
   Greeter.Start_Greet (Later, "later");
   Ada.Text_IO.Put_Line (Greeting.IGreeter.Finish_Greet (Later));
end Caller;
