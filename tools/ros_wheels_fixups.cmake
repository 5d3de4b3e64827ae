# The ROS wheels' CMake exports name the include folder of the Python that built them, which no other
# machine has, and every package that depends on messages then fails at generate time. This takes those
# folders out again. Passed with -DCMAKE_PROJECT_INCLUDE; on a real ROS it matches nothing.
function(_ros_wheels_fixups)
  get_property(_targets DIRECTORY PROPERTY IMPORTED_TARGETS)
  foreach(_t IN LISTS _targets)
    get_target_property(_incs ${_t} INTERFACE_INCLUDE_DIRECTORIES)
    if(_incs)
      list(FILTER _incs EXCLUDE REGEX "^/opt/python/cp")
      set_target_properties(${_t} PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${_incs}")
    endif()
  endforeach()
endfunction()
cmake_language(DEFER CALL _ros_wheels_fixups)
