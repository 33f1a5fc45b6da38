# What alpenglow::lut links to beside alpenglow::atmosphere.
include(CMakeFindDependencyMacro)

find_dependency(OpenEXR)
find_dependency(PNG)
