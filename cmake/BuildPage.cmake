# cmake -DWEB=<folder> -DOUTPUT=<file> -P BuildPage.cmake
# builds the page of `sheave view` with npm. Without npm, or without what it has to load, there is no page and the build
# goes on: the command then says so.
find_program(NPM npm)
if(NOT NPM)
  message(STATUS "web: no npm, so `sheave view` will have no page")
  return()
endif()

# What npm has installed is used until the lock file names something else.
file(SHA256 "${WEB}/package-lock.json" wanted)
set(stamp "${WEB}/node_modules/.sheave-lock")
set(installed "")
if(EXISTS "${stamp}")
  file(READ "${stamp}" installed)
endif()
if(NOT installed STREQUAL wanted)
  execute_process(
    COMMAND "${NPM}" ci --no-audit --no-fund --loglevel=error
    WORKING_DIRECTORY "${WEB}"
    RESULT_VARIABLE status
    OUTPUT_VARIABLE output
    ERROR_VARIABLE output
    TIMEOUT 300)
  if(NOT status EQUAL 0)
    message(STATUS "web: npm ci failed, so `sheave view` will have no page:\n${output}")
    return()
  endif()
  file(WRITE "${stamp}" "${wanted}")
endif()
execute_process(COMMAND "${NPM}" run --silent build WORKING_DIRECTORY "${WEB}" RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  # Here our own source is at fault.
  message(FATAL_ERROR "web: the page does not build")
endif()
configure_file("${WEB}/dist/view.html" "${OUTPUT}" COPYONLY)
