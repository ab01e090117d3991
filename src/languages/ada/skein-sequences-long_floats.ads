with Ada.Containers.Vectors;

package Skein.Sequences.Long_Floats is new Ada.Containers.Vectors (Positive, Long_Float);
