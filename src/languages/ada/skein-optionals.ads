--  A member that may be absent.
generic
   type Element is private;
package Skein.Optionals is

   type Optional (Present : Boolean := False) is record
      case Present is
         when True =>
            Value : Element;
         when False =>
            null;
      end case;
   end record;

   None : constant Optional := (Present => False);
   function Given (Value : Element) return Optional is ((Present => True, Value => Value));

end Skein.Optionals;
