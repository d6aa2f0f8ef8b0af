#include <voussoir/fem/simd.h>
#include <iostream>
int main(){ std::cout << Voussoir::simd_description() << std::endl; }
