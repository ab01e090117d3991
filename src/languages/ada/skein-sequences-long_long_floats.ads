with Ada.Containers.Vectors;

package Skein.Sequences.Long_Long_Floats is new Ada.Containers.Vectors (Positive, Long_Long_Float);
