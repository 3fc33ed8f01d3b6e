! The contacts of stickslip for Fortran: user elements and friction routines of finite-element codes (UEL, VFRIC) keep a
! fixed number of doubles for each contact, which ss_packed_fixed writes into their state variables.
module stickslip
    use, intrinsic :: iso_c_binding
    implicit none
    integer(c_int), parameter :: ss_ok = 0, ss_constant_load = 0, ss_indentation = 1, ss_normal_force = 2

    interface
        integer(c_int) function ss_contact_new(json, contact) bind(c)
            import :: c_int, c_char, c_ptr
            character(kind=c_char), intent(in) :: json(*)
            type(c_ptr), intent(out) :: contact
        end function
        integer(c_int) function ss_free(contact) bind(c)
            import :: c_int, c_ptr
            type(c_ptr), value :: contact
        end function
        integer(c_int) function ss_step(contact, load, normal, displacement, forces) bind(c)
            import :: c_int, c_ptr, c_double
            type(c_ptr), value :: contact
            integer(c_int), value :: load
            real(c_double), value :: normal
            real(c_double), intent(in) :: displacement(*)
            real(c_double), intent(out) :: forces(*)
        end function
        integer(c_int) function ss_trial(contact, load, normal, displacement, forces) bind(c)
            import :: c_int, c_ptr, c_double
            type(c_ptr), value :: contact
            integer(c_int), value :: load
            real(c_double), value :: normal
            real(c_double), intent(in) :: displacement(*)
            real(c_double), intent(out) :: forces(*)
        end function
        integer(c_int) function ss_commit(contact) bind(c)
            import :: c_int, c_ptr
            type(c_ptr), value :: contact
        end function
        integer(c_int) function ss_stiffness(contact, direction, stiffness) bind(c)
            import :: c_int, c_ptr, c_double
            type(c_ptr), value :: contact
            integer(c_int), value :: direction
            real(c_double), intent(out) :: stiffness(2)
        end function
        integer(c_int) function ss_packed_fixed(contact, turning_points, numbers, dropped) bind(c)
            import :: c_int, c_ptr, c_double, c_size_t
            type(c_ptr), value :: contact
            integer(c_size_t), value :: turning_points
            real(c_double), intent(out) :: numbers(*)
            integer(c_int), intent(out) :: dropped
        end function
        integer(c_int) function ss_unpack_fixed(contact, turning_points, numbers) bind(c)
            import :: c_int, c_ptr, c_double, c_size_t
            type(c_ptr), value :: contact
            integer(c_size_t), value :: turning_points
            real(c_double), intent(in) :: numbers(*)
        end function
    end interface
end module
