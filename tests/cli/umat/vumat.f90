! SPDX-License-Identifier: LGPL-2.1-or-later
! A VUMAT for the tests: J2 plasticity with linear hardening of Cauchy's stress.
! PROPS: Young's modulus, Poisson's ratio, yield stress, hardening modulus. stateNew(:, 1): equivalent
! plastic strain.

subroutine vumat(nblock, ndir, nshr, nstatev, nfieldv, nprops, lanneal, steptime, totaltime, dt, cmname, &
    coordmp, charlength, props, density, straininc, relspininc, tempold, stretchold, defgradold, &
    fieldold, stressold, stateold, enerinternold, enerinelasold, tempnew, stretchnew, defgradnew, &
    fieldnew, stressnew, statenew, enerinternnew, enerinelasnew)
  implicit none
  integer :: nblock, ndir, nshr, nstatev, nfieldv, nprops, lanneal
  character(len=80) :: cmname
  double precision :: steptime, totaltime, dt, coordmp(nblock, *), charlength(nblock), props(nprops), &
      density(nblock), straininc(nblock, ndir+nshr), relspininc(nblock, nshr), tempold(nblock), &
      stretchold(nblock, ndir+nshr), defgradold(nblock, ndir+nshr+nshr), fieldold(nblock, nfieldv), &
      stressold(nblock, ndir+nshr), stateold(nblock, nstatev), enerinternold(nblock), &
      enerinelasold(nblock), tempnew(nblock), stretchnew(nblock, ndir+nshr), defgradnew(nblock, &
      ndir+nshr+nshr), fieldnew(nblock, nfieldv), stressnew(nblock, ndir+nshr), statenew(nblock, &
      nstatev), enerinternnew(nblock), enerinelasnew(nblock)
  double precision :: bulk, shear, s(6), pressure, q, excess, strain, work
  integer :: k
  integer, pointer :: nowhere

  bulk = props(1) / (3 * (1 - 2 * props(2)))
  shear = props(1) / (2 * (1 + props(2)))
  do k = 1, nblock
    pressure = sum(stressold(k, 1:3)) / 3 + bulk * sum(straininc(k, 1:3))
    s = stressold(k, :) + 2 * shear * straininc(k, :)
    s(1:3) = s(1:3) - sum(s(1:3)) / 3
    q = sqrt(1.5d0 * (sum(s(1:3)**2) + 2 * sum(s(4:6)**2)))
    strain = 0
    excess = q - props(3) - props(4) * stateold(k, 1)
    if (excess > 0 .and. totaltime > 0) then
      strain = excess / (3 * shear + props(4))
      s = s * (1 - 3 * shear * strain / q)
    end if
    statenew(k, 1) = stateold(k, 1) + strain
    stressnew(k, :) = s
    stressnew(k, 1:3) = s(1:3) + pressure
    work = sum((stressold(k, 1:3) + stressnew(k, 1:3)) * straininc(k, 1:3)) / 2 + sum((stressold(k, 4:6) &
        + stressnew(k, 4:6)) * straininc(k, 4:6))
    enerinternnew(k) = enerinternold(k) + work / density(k)
    enerinelasnew(k) = enerinelasold(k) + (props(3) + props(4) * statenew(k, 1)) * strain / density(k)
    if (cmname == 'BEYOND STATENEW') call write_to(statenew, nblock * nstatev + 1)
    if (cmname == 'FAR BEYOND STATENEW') call write_to(statenew, nblock * (nstatev + 400))
    if (cmname == 'CRASH' .and. statenew(k, 1) > 0.01d0) then
      nullify(nowhere)
      nowhere = k
    end if
    if (cmname == 'STRESS' .and. statenew(k, 1) > 0.01d0) stressnew(k, 5) = sqrt(-stressnew(k, 5)**2 - 1)
  end do

contains

  subroutine write_to(array, place)
    integer, intent(in) :: place
    double precision, intent(inout) :: array(*)
    array(place) = 7
  end subroutine

end subroutine
