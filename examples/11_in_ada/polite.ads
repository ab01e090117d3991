with Greeter_IDL;

package Polite is

   type Greeter is new Greeter_IDL.Greeting.IGreeter.Service with null record;
   overriding function Greet (Self : in out Greeter; Name : String) return String is ("Hello, " & Name & "!");

end Polite;
