with Ada.Containers.Vectors;

package Skein.Sequences.Wide_Characters is new Ada.Containers.Vectors (Positive, Wide_Character);
